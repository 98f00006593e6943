#include "simulation/mesh/orientation.h"

#include <array>
#include <cmath>
#include <limits>

namespace weft {

namespace {

constexpr double kUlp = 0.5 * std::numeric_limits<double>::epsilon();

/// A number as a sum of doubles that do not overlap, the smallest first: Shewchuk's expansions.
class ExactSum {
public:
    /// a * b * c, of which a and b are single precision, so that a * b is a double.
    void add_product(double a, double b, double c) {
        const double ab = a * b;
        const double high = ab * c;
        add(std::fma(ab, c, -high));
        add(high);
    }

    int sign() const {
        for (std::size_t i = count_; i-- > 0;) {
            if (parts_[i] != 0.0) return parts_[i] > 0.0 ? 1 : -1;
        }
        return 0;
    }

private:
    void add(double x) {
        for (std::size_t i = 0; i < count_; ++i) {
            double& part = parts_[i];
            const double sum = x + part;
            const double back = sum - x;
            part = (x - (sum - back)) + (part - back);
            x = sum;
        }
        parts_[count_++] = x;
    }

    std::array<double, 48> parts_{};  // two of each product
    std::size_t count_ = 0;
};

void add_determinant(ExactSum& sum, double sign, Vec3 a, Vec3 b, Vec3 c) {
    sum.add_product(a.x, b.y, sign * c.z);
    sum.add_product(a.x, b.z, -sign * c.y);
    sum.add_product(a.y, b.z, sign * c.x);
    sum.add_product(a.y, b.x, -sign * c.z);
    sum.add_product(a.z, b.x, sign * c.y);
    sum.add_product(a.z, b.y, -sign * c.x);
}

int exact_side(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
    ExactSum sum;
    add_determinant(sum, 1.0, p, b, c);
    add_determinant(sum, 1.0, a, p, c);
    add_determinant(sum, 1.0, a, b, p);
    add_determinant(sum, -1.0, a, b, c);
    return sum.sign();
}

struct Point2 {
    double u, v;
};

Point2 seen_along(Vec3 p, int axis) {
    if (axis == 0) return {p.y, p.z};
    return axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

int exact_turn(Point2 a, Point2 b, Point2 c) {
    ExactSum sum;
    sum.add_product(a.u, b.v, 1.0);
    sum.add_product(a.v, b.u, -1.0);
    sum.add_product(b.u, c.v, 1.0);
    sum.add_product(b.v, c.u, -1.0);
    sum.add_product(c.u, a.v, 1.0);
    sum.add_product(c.v, a.u, -1.0);
    return sum.sign();
}

int sign_of(double x) { return x > 0.0 ? 1 : (x < 0.0 ? -1 : 0); }

}  // namespace

int side_of(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
    const Vec3 u = b - a, v = c - a, w = p - a;
    const double uv[6] = {u.y * v.z, u.z * v.y, u.z * v.x, u.x * v.z, u.x * v.y, u.y * v.x};
    const double volume = w.x * (uv[0] - uv[1]) + w.y * (uv[2] - uv[3]) + w.z * (uv[4] - uv[5]);
    const double size = std::abs(w.x) * (std::abs(uv[0]) + std::abs(uv[1])) +
                        std::abs(w.y) * (std::abs(uv[2]) + std::abs(uv[3])) +
                        std::abs(w.z) * (std::abs(uv[4]) + std::abs(uv[5]));
    constexpr double kBound = (7.0 + 56.0 * kUlp) * kUlp;
    if (size == 0.0 || std::abs(volume) > kBound * size) return sign_of(volume);
    return exact_side(a, b, c, p);
}

int turn_of(Vec3 a, Vec3 b, Vec3 c, int axis) {
    const Point2 p = seen_along(a, axis), q = seen_along(b, axis), r = seen_along(c, axis);
    const double left = (q.u - p.u) * (r.v - p.v);
    const double right = (q.v - p.v) * (r.u - p.u);
    constexpr double kBound = (3.0 + 16.0 * kUlp) * kUlp;
    const double size = std::abs(left) + std::abs(right);
    if (size == 0.0 || std::abs(left - right) > kBound * size) return sign_of(left - right);
    return exact_turn(p, q, r);
}

}  // namespace weft
