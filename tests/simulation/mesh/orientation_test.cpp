#include "simulation/mesh/orientation.h"

#include <gtest/gtest.h>

#include <random>

namespace weft {
namespace {

using Wide = __int128;

/// Exact: coordinates are integers below 2^24.
int side_of_integers(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
    const auto x = [](double v) { return static_cast<Wide>(v); };
    const Wide u[3] = {x(b.x - a.x), x(b.y - a.y), x(b.z - a.z)};
    const Wide v[3] = {x(c.x - a.x), x(c.y - a.y), x(c.z - a.z)};
    const Wide w[3] = {x(p.x - a.x), x(p.y - a.y), x(p.z - a.z)};
    const Wide volume = w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
                        w[2] * (u[0] * v[1] - u[1] * v[0]);
    return volume > 0 ? 1 : (volume < 0 ? -1 : 0);
}

class Points {
public:
    Vec3 next() { return {one(), one(), one()}; }
    int number(int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(generator_);
    }

private:
    double one() { return number(-(1 << 23), 1 << 23); }
    std::mt19937 generator_{7};
};

TEST(Orientation, OfPointsNextToAPlaneIsThatOfIntegers) {
    Points points;
    int in_plane = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 a = points.next(),
                   u = {1.0 * points.number(-99, 99), 1.0 * points.number(-99, 99),
                        1.0 * points.number(-99, 99)};
        const Vec3 v = {1.0 * points.number(-99, 99), 1.0 * points.number(-99, 99),
                        1.0 * points.number(-99, 99)};
        const int far = points.number(1, 20000);
        Vec3 p = a + static_cast<double>(points.number(-far, far)) * u +
                 static_cast<double>(points.number(-far, far)) * v;
        if (trial % 2 == 0) p.y += points.number(-1, 1);
        const Vec3 b = a + static_cast<double>(far) * u, c = a + static_cast<double>(far) * v;
        const auto fits = [](Vec3 x) {
            return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) <= 0x1p24;
        };
        if (!fits(b) || !fits(c) || !fits(p)) continue;
        const int expected = side_of_integers(a, b, c, p);
        in_plane += expected == 0 ? 1 : 0;
        // The same at another scale, where rounding is another one.
        const double scale = std::ldexp(1.0, points.number(-60, 60));
        EXPECT_EQ(side_of(a, b, c, p), expected);
        EXPECT_EQ(side_of(scale * a, scale * b, scale * c, scale * p), expected);
        EXPECT_EQ(side_of(b, a, c, p), -expected);
    }
    EXPECT_GT(in_plane, 1000);
}

TEST(Orientation, SeesTheLastBit) {
    // A plane through the origin far out: differences of coordinates are rounded in double.
    const Vec3 a{1e-20f, 1e-20f, 1e-20f}, b{1e8f, 0.0, 1e8f}, c{0.0, 1e8f, 1e8f};
    const Vec3 p{1e8f, 1e8f, 2e8f};
    EXPECT_EQ(side_of({}, b, c, p), 0);
    EXPECT_EQ(side_of({}, b, c, {p.x, p.y, std::nextafter(2e8f, 3e8f)}), 1);
    // z = x + y for b, c and p, and not quite for a.
    EXPECT_EQ(side_of(a, b, c, p), -1);
    EXPECT_EQ(side_of({1e-20f, 1e-20f, 2e-20f}, b, c, p), 0);
}

TEST(Orientation, TurnsInThePlane) {
    EXPECT_EQ(turn_of({0, 0, 5}, {1, 0, 6}, {0, 1, 7}, 2), 1);
    EXPECT_EQ(turn_of({5, 0, 0}, {6, 1, 0}, {7, 0, 1}, 0), 1);
    EXPECT_EQ(turn_of({0, 5, 0}, {0, 6, 1}, {1, 7, 0}, 1), 1);
    EXPECT_EQ(turn_of({0, 0, 0}, {0.1f, 0.1f, 0}, {0.3f, 0.3f, 0}, 2), 0);
    EXPECT_EQ(turn_of({0, 0, 0}, {1e8f, 1e8f, 0}, {3.0f, std::nextafter(3.0f, 4.0f), 0}, 2), 1);
    EXPECT_EQ(turn_of({1, 2, 3}, {1, 2, 3}, {3, 4, 5}, 2), 0);
}

}  // namespace
}  // namespace weft
