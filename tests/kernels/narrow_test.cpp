// Triangles whose vertices are all far from an obstacle are kept out of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/obstacles/narrow.h"
#include "simulation/mesh/vec3.h"
#include "tests/kernels/random.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

constexpr float kThickness = 0.0625f;
/// The core goes through the triangle, or nearly: looking everywhere does so in steps.
constexpr double kCrossing = 0.02;

Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

struct Shape {
    float number;
    float4 dimensions;
    float4 core;
};
constexpr Shape kSphere{WEFT_OBSTACLE_sphere, {0.25f, 0, 0, 0}, {0, 0, 0, 0.25f}};
constexpr Shape kCapsule{WEFT_OBSTACLE_capsule, {0.25f, 1.5f, 0, 0}, {0, 1.5f, 0, 0.25f}};
constexpr Shape kPlate{WEFT_OBSTACLE_box, {1.0f, 0.125f, 0.5f, 0}, {0.875f, 0, 0.375f, 0.125f}};
constexpr Shape kShapes[] = {kSphere, kCapsule, kPlate};

/// A triangle and an obstacle at the origin.
struct Meeting {
    Buffer<float4> positions{"positions", 3};
    Buffer<float4> previous{"previous", 3};
    Buffer<float4> rows{"obstacles", WEFT_OBSTACLE_ROWS};
    Buffer<int> corners{"corners", 9};
    Buffer<float4> planes{"planes", 3};
    Buffer<float> depths{"depths", 3};
    Shape shape;

    Meeting(const Shape& of, std::array<float4, 3> from, std::array<float4, 3> to) : shape(of) {
        for (const std::size_t map : {0, 3}) {
            rows[map] = {1, 0, 0, 0};
            rows[map + 1] = {0, 1, 0, 0};
            rows[map + 2] = {0, 0, 1, 0};
        }
        rows[6] = shape.dimensions;
        const float quarter = 0.5f * shape.core.w + kThickness;
        rows[7] = {kThickness, 0.0f, quarter * quarter, shape.number};
        for (std::size_t v = 0; v < 3; ++v) {
            positions[v] = to[v];
            positions[v].w = 1.0f;
            previous[v] = from[v];
            for (std::size_t k = 0; k < 3; ++k) corners[3 * k + v] = static_cast<int>(k);
        }
    }

    void find(int substep = 0) {
        const Launch launched =
            launch(kernels::find_obstacle_planes, Segments{}, positions, previous, corners, rows,
                   planes, depths, /*notes=*/1, 3, 1, /*reach=*/8.0f, 1, 0, 0, substep);
        run_on_host(launched, launched.kernel->scalar, 0, 3);
    }
    /// By the planes alone: corners are nowhere near a sphere of that size.
    void push() {
        Buffer<float4> far("obstacles", WEFT_OBSTACLE_ROWS);
        std::copy(rows.data(), rows.data() + WEFT_OBSTACLE_ROWS, far.data());
        far[6].x = -1000.0f;
        const Launch launched =
            launch(kernels::push_out_of_sphere, Segments{}, positions, previous, previous, previous,
                   far, planes, WEFT_PUSH_ALONE, 3, 0, 1, 0, 0);
        run_on_host(launched, launched.kernel->scalar, 0, 3);
    }
    void keep_out(int rounds) {
        for (int round = 0; round < rounds; ++round) {
            find();
            push();
        }
    }
    Vec3 corner(std::size_t v) const { return vec(positions[v]); }
    Vec3 middle() const { return (1.0 / 3.0) * (corner(0) + corner(1) + corner(2)); }

    /// From the core, by looking everywhere.
    double distance() const {
        constexpr int kSteps = 200;
        double least = std::numeric_limits<double>::max();
        const auto beyond = [](double p, float half) {
            return std::max(std::abs(p) - static_cast<double>(half), 0.0);
        };
        for (int i = 0; i <= kSteps; ++i) {
            for (int j = 0; i + j <= kSteps; ++j) {
                const double u = static_cast<double>(i) / kSteps;
                const double v = static_cast<double>(j) / kSteps;
                const Vec3 p = u * corner(0) + v * corner(1) + (1.0 - u - v) * corner(2);
                least =
                    std::min(least, length({beyond(p.x, shape.core.x), beyond(p.y, shape.core.y),
                                            beyond(p.z, shape.core.z)}));
            }
        }
        return least;
    }
};

std::array<float4, 3> random_triangle(Random& random) {
    return {random.point(1.5f), random.point(1.5f), random.point(1.5f)};
}

/// Some of these lie above a plate.
std::array<float4, 3> small_triangle(Random& random) {
    std::array<float4, 3> t = {random.point(0.25f), random.point(0.25f), random.point(0.25f)};
    const float4 place = random.point(0.75f);
    for (float4& corner : t) {
        corner.x += place.x;
        corner.y += place.y;
        corner.z += place.z;
    }
    return t;
}

kernels::real3 real(const float4& v) { return kernels::make3(v.x, v.y, v.z); }

TEST(NarrowObstacles, TrianglesAreAsFarAsLookingEverywhereSays) {
    Random random(5);
    for (const Shape& shape : kShapes) {
        for (int n = 0; n < 120; ++n) {
            const auto t = n % 2 == 0 ? random_triangle(random) : small_triangle(random);
            const Meeting meeting(shape, t, t);
            const auto met = kernels::meet_core({real(t[0]), real(t[1]), real(t[2])},
                                                kernels::core_of(meeting.rows.data()));
            EXPECT_NEAR(met.weights.x + met.weights.y + met.weights.z, 1.0f, 1e-5f);
            const double expected = meeting.distance();
            if (expected < kCrossing) continue;
            EXPECT_NEAR(static_cast<double>(met.distance), expected, 1e-3) << shape.number << n;
        }
    }
}

TEST(NarrowObstacles, TrianglesArePushedOut) {
    Random random(6);
    for (const Shape& shape : kShapes) {
        const double kept = static_cast<double>(shape.core.w + kThickness);
        int pushed = 0;
        for (int n = 0; n < 60; ++n) {
            const auto t = random_triangle(random);
            Meeting meeting(shape, t, t);
            if (meeting.distance() < kCrossing) continue;  // no side is its own
            pushed += meeting.distance() < kept ? 1 : 0;
            meeting.keep_out(100);
            EXPECT_GT(meeting.distance(), kept - 0.02) << shape.number << " " << n;
        }
        EXPECT_GT(pushed, 5) << "nothing to do for " << shape.number;
    }
}

/// All of a triangle has gone through a bar in one substep, and none of its corners has met it.
TEST(NarrowObstacles, TrianglesDoNotPassInOneStep) {
    const auto at = [](float y) {
        return std::array<float4, 3>{float4{-1.0f, y, 0.0f, 0}, float4{1.0f, y, -0.8f, 0},
                                     float4{1.0f, y, 0.8f, 0}};
    };
    const Shape bar{WEFT_OBSTACLE_box, {0.0625f, 0.0625f, 2.0f, 0}, {0, 0, 1.9375f, 0.0625f}};
    for (const float end : {-0.25f, -1.0f, -4.0f}) {
        Meeting meeting(bar, at(0.5f), at(end));
        meeting.keep_out(20);
        EXPECT_GT(meeting.middle().y, 0.0) << end;
        EXPECT_GT(meeting.distance(), 0.125 - 0.01) << end;
        Meeting beside(bar, at(0.5f), at(end));
        for (float4* x : {beside.positions.data(), beside.previous.data()}) {
            for (int v = 0; v < 3; ++v) x[v].x += 1.5f;
        }
        beside.keep_out(20);
        EXPECT_EQ(beside.middle().y, static_cast<double>(end)) << "it does not come by";
    }
}

TEST(NarrowObstacles, TheMostDepthOfAFrameIsNoted) {
    const auto at = [](float y) {
        return std::array<float4, 3>{float4{-1.0f, y, 0.0f, 0}, float4{1.0f, y, -0.8f, 0},
                                     float4{1.0f, y, 0.8f, 0}};
    };
    Meeting meeting(kSphere, at(0.2f), at(0.2f));
    const auto expect = [&](float depth) {
        for (const float noted : meeting.depths.span()) EXPECT_NEAR(noted, depth, 1e-6f);
    };
    meeting.find();
    expect(0.3125f - 0.2f);
    for (float4& x : meeting.positions.span()) x.y = 0.3f;
    meeting.find(1);
    expect(0.3125f - 0.2f);
    meeting.find();
    expect(0.3125f - 0.3f);
    for (float4& x : meeting.positions.span()) x.y = 0.4f;
    meeting.find();
    expect(0.0f);
}

TEST(NarrowObstacles, HeldCornersStayAndOthersMoveForThem) {
    const float y = 0.2f;
    const std::array<float4, 3> t{float4{-1.0f, y, 0.0f, 0}, float4{1.0f, y, -0.8f, 0},
                                  float4{1.0f, y, 0.8f, 0}};
    Meeting free(kSphere, t, t), held(kSphere, t, t);
    held.positions[0].w = 0.0f;
    for (Meeting* meeting : {&free, &held}) {
        meeting->keep_out(1);
        EXPECT_NEAR(meeting->distance(), 0.3125, 3e-3) << "the first push is all but enough";
    }
    EXPECT_EQ(held.corner(0).y, static_cast<double>(y));
    EXPECT_GT(free.corner(0).y, static_cast<double>(y));
    EXPECT_GT(held.corner(1).y, free.corner(1).y);
}

}  // namespace
}  // namespace weft::test
