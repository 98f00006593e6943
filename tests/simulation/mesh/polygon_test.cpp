#include "simulation/mesh/polygon.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace weft {
namespace {

Vec3 area_of(std::span<const Vec3> x, const std::array<int, 3>& t) {
    const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
    return 0.5 * cross(at(1) - at(0), at(2) - at(0));
}

/// Whatever the splitting, n - 2 triangles that turn as the polygon does and fill its area.
void expect_split(const std::vector<Vec3>& x) {
    const auto triangles = split_polygon(x);
    ASSERT_EQ(triangles.size(), x.size() - 2);
    Vec3 whole;
    for (std::size_t i = 0; i < x.size(); ++i) {
        whole = whole + 0.5 * cross(x[i], x[(i + 1) % x.size()]);
    }
    double sum = 0.0;
    for (const auto& t : triangles) {
        EXPECT_GT(dot(area_of(x, t), whole), 0.0);
        sum += length(area_of(x, t));
    }
    EXPECT_NEAR(sum, length(whole), 1e-12 * length(whole));
}

/// A star around the origin: its corners see it, so it never crosses itself.
std::vector<Vec3> random_star(std::mt19937& random, int corners) {
    std::uniform_real_distribution<double> radius(0.2, 2.0);
    const Mat3 turn = rotation_matrix({radius(random), radius(random), radius(random)}, 77.0);
    std::vector<Vec3> x;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        const double r = radius(random);
        x.push_back(turn * Vec3{r * std::cos(angle), r * std::sin(angle), 0.0});
    }
    return x;
}

TEST(Polygon, StarsOfAllKindsAreFilled) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 300; ++trial) expect_split(random_star(random, 4 + trial % 20));
}

TEST(Polygon, QuadIsCutAlongTheShorterDiagonal) {
    using Triangles = std::vector<std::array<int, 3>>;
    const std::vector<Vec3> kite{{0, 0, 0}, {1, -1, 0}, {9, 0, 0}, {1, 1, 0}};
    EXPECT_EQ(split_polygon(kite), (Triangles{{1, 2, 3}, {0, 1, 3}}));
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(split_polygon(square), (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

/// The diagonal between its tips is the shorter one, and outside.
TEST(Polygon, ArrowHeadIsCutInside) {
    expect_split({{0, 0, 0}, {0.2, 1, 0}, {0, 0.5, 0}, {-0.2, 1, 0}});
}

TEST(Polygon, CornersInALineAreKept) {
    expect_split(
        {{0, 0, 0}, {0.1, 0, 0}, {0.3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.7, 1, 0}, {0, 1, 0}});
}

TEST(Polygon, RefusesWhatCrossesItselfOrHasNoArea) {
    EXPECT_TRUE(
        split_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
    EXPECT_TRUE(
        split_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).empty());
    EXPECT_TRUE(split_polygon(std::vector<Vec3>(5, Vec3{1, 2, 3})).empty());
}

}  // namespace
}  // namespace weft
