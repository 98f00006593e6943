#include "simulation/mesh/polygon.h"

#include <algorithm>
#include <numeric>

namespace weft {
namespace {

// Of the polygon's area: corners in a straight line have less by their rounding.
constexpr double kLeastArea = 1e-12;

class PolygonSplitter {
public:
    explicit PolygonSplitter(std::span<const Vec3> corners)
        : x_(corners),
          normal_(newell_normal(corners)),
          least_(kLeastArea * dot(normal_, normal_)),
          left_(corners.size()) {
        std::iota(left_.begin(), left_.end(), 0);
    }

    std::vector<std::array<int, 3>> split() {
        std::size_t at = x_.size() == 4 ? first_of_quad() : 0;
        while (left_.size() > 3) {
            at = next_ear(at);
            if (at == left_.size()) return {};
            cut(at);
            // On to a fresh corner, so that the triangles do not all fan out from one.
            at = (at + 1) % left_.size();
        }
        if (!turns_left(0)) return {};
        cut(0);
        return std::move(triangles_);
    }

private:
    /// Twice the area, along the normal.
    static Vec3 newell_normal(std::span<const Vec3> x) {
        Vec3 sum;
        for (std::size_t i = 1; i + 1 < x.size(); ++i) {
            sum = sum + cross(x[i] - x[0], x[i + 1] - x[0]);
        }
        return sum;
    }

    int corner(std::size_t place) const { return left_[place % left_.size()]; }
    Vec3 position(std::size_t place) const { return x_[static_cast<std::size_t>(corner(place))]; }
    std::size_t before(std::size_t place) const { return place + left_.size() - 1; }

    /// Of a triangle, times four times the polygon's; negative where it turns the other way.
    double area(Vec3 a, Vec3 b, Vec3 c) const { return dot(cross(b - a, c - a), normal_); }
    bool turns_left(std::size_t place) const {
        return area(position(before(place)), position(place), position(place + 1)) > least_;
    }

    /// Whether the triangle at this corner lies inside what is left.
    bool is_ear(std::size_t place) const {
        if (!turns_left(place)) return false;
        const Vec3 a = position(before(place)), b = position(place), c = position(place + 1);
        for (std::size_t other = 2; other + 1 < left_.size(); ++other) {
            const Vec3 p = position(place + other);
            const double least = std::min({area(a, b, p), area(b, c, p), area(c, a, p)});
            if (least >= -least_) return false;
        }
        return true;
    }

    /// The ear whose cut is the shorter diagonal; of two alike, the one from the first corner.
    std::size_t first_of_quad() const {
        const double from_first = length(x_[2] - x_[0]);
        const double from_second = length(x_[3] - x_[1]);
        return from_second < from_first * (1.0 - 1e-6) ? 2 : 1;
    }

    std::size_t next_ear(std::size_t start) const {
        for (std::size_t i = 0; i < left_.size(); ++i) {
            const std::size_t place = (start + i) % left_.size();
            if (is_ear(place)) return place;
        }
        return left_.size();
    }

    void cut(std::size_t place) {
        std::array<int, 3> triangle{corner(before(place)), corner(place), corner(place + 1)};
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                    triangle.end());
        triangles_.push_back(triangle);
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(place));
    }

    std::span<const Vec3> x_;
    Vec3 normal_;
    double least_;
    std::vector<int> left_;
    std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

std::vector<std::array<int, 3>> split_polygon(std::span<const Vec3> corners) {
    return PolygonSplitter(corners).split();
}

}  // namespace weft
