#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernels/obstacles/box.h"
#include "kernels/obstacles/capsule.h"
#include "kernels/obstacles/plane.h"
#include "kernels/obstacles/sphere.h"
#include "simulation/mesh/vec3.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kThickness = 0.125f;
constexpr double kThicknessOf = static_cast<double>(kThickness);
constexpr float kFriction = 0.5f;

Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

/// One vertex and one obstacle at the origin.
struct Contact {
    Buffer<float4> positions{"positions", 1};
    Buffer<float4> previous{"previous", 1};
    Buffer<float4> targets{"targets", 1};
    Buffer<float4> pressing{"pressing", 1};
    Buffer<float4> rows{"obstacles", WEFT_OBSTACLE_ROWS};

    Contact(Vec3 point, float4 dimensions, float inverse_mass = 1.0f) {
        positions[0] = {static_cast<float>(point.x), static_cast<float>(point.y),
                        static_cast<float>(point.z), inverse_mass};
        previous[0] = positions[0];
        for (const std::size_t map : {0, 3}) {
            rows[map] = {1, 0, 0, 0};
            rows[map + 1] = {0, 1, 0, 0};
            rows[map + 2] = {0, 0, 1, 0};
        }
        rows[6] = dimensions;
        rows[7] = {kThickness, kFriction, std::numeric_limits<float>::max(), 0};
    }
    template <class Kernel>
    Vec3 push(Kernel kernel) {
        rows[7].y = 0.0f;
        return rub(kernel);
    }
    template <class Kernel>
    Vec3 rub(Kernel kernel, int told = WEFT_PUSH_ALONE) {
        const Launch push = launch(kernel, Segments{}, positions, previous, targets, pressing, rows,
                                   previous, told, 1,
                                   /*narrow=*/-1, 1, 0, 0);
        run_on_host(push, push.kernel->scalar, 0, 1);
        return vec(positions[0]);
    }
};

void expect_at(Vec3 actual, Vec3 expected, double tolerance = 1e-6) {
    EXPECT_LE(length(actual - expected), tolerance)
        << "(" << actual.x << ", " << actual.y << ", " << actual.z << ")";
}

/// Where push_out_of_... moves a point to.
template <class Kernel>
Vec3 pushed(Kernel kernel, Vec3 point, float4 dimensions, float inverse_mass = 1.0f) {
    return Contact(point, dimensions, inverse_mass).push(kernel);
}

TEST(Obstacles, SpherePushesToItsSurfaceAndThickness) {
    const auto& sphere = kernels::push_out_of_sphere;
    const float4 d{0.5f, 0, 0, 0};
    expect_at(pushed(sphere, {0.3, 0, 0}, d), {0.625, 0, 0});
    expect_at(pushed(sphere, {0.3, -0.4, 0}, d), {0.375, -0.5, 0});   // on the surface
    expect_at(pushed(sphere, {0, 0.55, 0}, d), {0, 0.625, 0});        // within the thickness
    expect_at(pushed(sphere, {0, 0, 0}, d), {0, 0.625, 0});           // at the centre: upwards
    expect_at(pushed(sphere, {0, 0, -0.75}, d), {0, 0, -0.75}, 0.0);  // outside
}

TEST(Obstacles, PlanePushesUpwards) {
    const auto& plane = kernels::push_out_of_plane;
    expect_at(pushed(plane, {5, -3, 2}, {}), {5, kThickness, 2});
    expect_at(pushed(plane, {5, 0.125, 2}, {}), {5, kThickness, 2}, 0.0);
    expect_at(pushed(plane, {5, 0.25, 2}, {}), {5, 0.25, 2}, 0.0);
}

TEST(Obstacles, CapsuleIsARoundedSegment) {
    const auto& capsule = kernels::push_out_of_capsule;
    const float4 d{0.5f, 1.0f, 0, 0};
    expect_at(pushed(capsule, {0.25, 0.9, 0}, d), {0.625, 0.9, 0});   // beside the segment
    expect_at(pushed(capsule, {0, 1.25, 0}, d), {0, 1.625, 0});       // above its end
    expect_at(pushed(capsule, {0.3, -1.4, 0}, d), {0.375, -1.5, 0});  // below, sideways
    expect_at(pushed(capsule, {0, 0.5, 0}, d), {0, 1.125, 0});        // on the axis: upwards
    expect_at(pushed(capsule, {0, 1.7, 0}, d), {0, 1.7f, 0}, 0.0);    // outside
}

TEST(Obstacles, BoxPushesThroughItsNearestFaceAndRoundsItsEdges) {
    const auto& box = kernels::push_out_of_box;
    const float4 d{1.0f, 0.5f, 0.75f, 0};
    expect_at(pushed(box, {0.9, 0.1, 0}, d), {1.125, 0.1, 0});
    expect_at(pushed(box, {0.1, -0.4, 0}, d), {0.1, -0.625, 0});
    expect_at(pushed(box, {0, 0, -0.7}, d), {0, 0, -0.875});
    expect_at(pushed(box, {0, 0, 0}, d), {0, 0.625, 0});              // the nearest face is y's
    expect_at(pushed(box, {0, 0.5, 0}, d), {0, 0.625, 0});            // on a face
    expect_at(pushed(box, {1.0, 0.5, 0.75}, d), {1.125, 0.5, 0.75});  // on a corner: one face
    expect_at(pushed(box, {1.0 + 0.045, 0.5 + 0.06, 0}, d), {1.075, 0.6, 0});  // outside an edge
    expect_at(pushed(box, {1.5, 0.75, 0}, d), {1.5, 0.75, 0}, 0.0);
}

TEST(Obstacles, FarFromTheOriginEverythingIsOutsideToTheBit) {
    const Vec3 far{3.3, 4.7, -5.1};
    const Vec3 same{3.3f, 4.7f, -5.1f};
    EXPECT_EQ(pushed(kernels::push_out_of_sphere, far, {0.5f, 0, 0, 0}), same);
    EXPECT_EQ(pushed(kernels::push_out_of_capsule, far, {0.5f, 1, 0, 0}), same);
    EXPECT_EQ(pushed(kernels::push_out_of_box, far, {1, 1, 1, 0}), same);
    EXPECT_EQ(pushed(kernels::push_out_of_plane, far, {}), same);
    EXPECT_EQ(Contact(far, {0.5f, 0, 0, 0}).rub(kernels::push_out_of_sphere), same);
    EXPECT_EQ(Contact(far, {0.5f, 1, 0, 0}).rub(kernels::push_out_of_capsule), same);
    EXPECT_EQ(Contact(far, {1, 1, 1, 0}).rub(kernels::push_out_of_box), same);
    EXPECT_EQ(Contact(far, {}).rub(kernels::push_out_of_plane), same);
}

TEST(Obstacles, HeldVerticesNeverMove) {
    const Vec3 inside{0.25, -0.125, 0};
    EXPECT_EQ(pushed(kernels::push_out_of_sphere, inside, {0.5f, 0, 0, 0}, 0.0f), inside);
    EXPECT_EQ(pushed(kernels::push_out_of_capsule, inside, {0.5f, 1, 0, 0}, 0.0f), inside);
    EXPECT_EQ(pushed(kernels::push_out_of_box, inside, {1, 1, 1, 0}, 0.0f), inside);
    EXPECT_EQ(pushed(kernels::push_out_of_plane, inside, {}, 0.0f), inside);
    Contact rubbed(inside, {}, 0.0f);
    rubbed.previous[0].x = 5.0f;
    EXPECT_EQ(rubbed.rub(kernels::push_out_of_plane), inside);
}

TEST(Obstacles, FrictionHoldsUpToItsShareOfTheDepthAndNoFurther) {
    // Depth 0.225 + 0.125, so friction takes back 0.175 at most.
    for (const double way : {0.02, 0.17, 0.18, 0.5}) {
        Contact contact({way, -0.225, 0}, {});
        contact.previous[0].x = 0.0f;
        const double slid = std::max(0.0, way - 0.35 * static_cast<double>(kFriction));
        expect_at(contact.rub(kernels::push_out_of_plane), {slid, kThickness, 0});
    }
}

/// As the step of its body as a whole may move it behind the pushes.
TEST(Obstacles, WhatFrictionHasLeftHoldsWhatIsPushedNoMore) {
    constexpr double kGrip = 0.35 * static_cast<double>(kFriction);
    Contact contact({0.05, -0.225, 0}, {});
    contact.previous[0].x = 0.0f;
    expect_at(contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LEADS), {0.0, kThickness, 0});
    EXPECT_NEAR(contact.targets[0].w, kGrip - 0.05, 1e-6);
    contact.positions[0].x = 0.1f;
    expect_at(contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LEADS), {0.1, kThickness, 0});
    expect_at(contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LAST), {0.0, kThickness, 0});
    EXPECT_NEAR(contact.targets[0].w, kGrip - 0.15, 1e-6);
    contact.positions[0].x = 0.1f;
    expect_at(contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LAST),
              {0.25 - kGrip, kThickness, 0});
    EXPECT_NEAR(contact.targets[0].w, 0.0, 1e-6);
    EXPECT_GT(contact.targets[0].w, 0.0f) << "it has been pushed";
}

TEST(Obstacles, FrictionHoldsNothingThatIsLiftedOff) {
    Contact contact({0.0, kThickness + 0.1f, 0}, {});
    contact.previous[0].x = 0.02f;
    contact.targets[0].w = 0.1f * kFriction;
    expect_at(contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LAST),
              {0.0, static_cast<double>(kThickness) + 0.1, 0});
    Contact apart({0.0, kThickness + 0.1f, 0}, {});
    apart.rub(kernels::push_out_of_plane, WEFT_PUSH_LAST);
    EXPECT_EQ(apart.targets[0].w, 0.0f) << "nor has it been pushed";
}

TEST(Obstacles, PushesLeadTargetsAlong) {
    for (const int told : {WEFT_PUSH_ALONE, WEFT_PUSH_LEADS, WEFT_PUSH_PRESSES, WEFT_PUSH_LAST}) {
        Contact contact({0.05, -0.225, 0}, {});
        contact.previous[0].x = 0.0f;
        contact.targets[0] = {0.5f, -0.5f, 0.25f, 0.0f};
        contact.rub(kernels::push_out_of_plane, told);
        const bool leads = told == WEFT_PUSH_LEADS || told == WEFT_PUSH_PRESSES;
        const Vec3 led = leads ? Vec3{-0.05, 0.35, 0.0} : Vec3{};
        expect_at(vec(contact.targets[0]), Vec3{0.5, -0.5, 0.25} + led);
    }
}

/// Across the surface, whatever friction does beside it.
TEST(Obstacles, WhatPressesAddsUp) {
    Contact contact({0.05, -0.225, 0}, {});
    contact.previous[0].x = 0.0f;
    contact.rub(kernels::push_out_of_plane, WEFT_PUSH_LEADS);
    EXPECT_EQ(contact.pressing[0].y, 0.0f) << "nobody asks";
    contact.positions[0].y = -0.225f;
    for (int push = 1; push <= 2; ++push) {
        contact.rub(kernels::push_out_of_plane, WEFT_PUSH_PRESSES);
        expect_at(vec(contact.pressing[0]), {0.0, push * 0.35, 0.0});
        contact.positions[0].y = -0.225f;
    }
}

TEST(Obstacles, MovingObstacleCarriesWhatItHolds) {
    Contact contact({0, -0.225, 0}, {});
    contact.rows[0].w = -0.1f;  // where the plane is now, is 0.1 m along x from where it was
    expect_at(contact.rub(kernels::push_out_of_plane), {0.1, kThickness, 0});
    Contact fast({0, -0.225, 0}, {});
    fast.rows[0].w = -10.0f;
    expect_at(fast.rub(kernels::push_out_of_plane), {0.175, kThickness, 0});
}

TEST(Obstacles, PlacementTurnsAndMovesTheShape) {
    // A box turned by a quarter about z and moved to x = 2: its long side now lies along y.
    Contact contact({2.0, 0.875, 0}, {1.0f, 0.5f, 0.5f, 0});
    contact.rows[0] = {0, 1, 0, 0};
    contact.rows[1] = {-1, 0, 0, 2};
    expect_at(contact.push(kernels::push_out_of_box), {2.0, 1.125, 0});
}

/// The signed distance in double precision, from the definition.
double distance_from_box(Vec3 p, Vec3 half) {
    const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3 out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    const double inside = std::max({q.x, q.y, q.z});
    return inside < 0.0 ? inside : length(out);
}

/// The least distance on the straight way between two points, by brute force.
template <class Distance>
double least_on_way(Vec3 start, Vec3 end, Distance distance) {
    double least = distance(start);
    for (int k = 1; k <= 2000; ++k) {
        least = std::min(least, distance(start + (k / 2000.0) * (end - start)));
    }
    return least;
}

/// Random ways, from outside an obstacle to anywhere: what misses it stays to the bit, and whatever
/// meets it ends where the way from its start is free.
template <class Kernel, class Distance>
void expect_swept(Kernel kernel, float4 dimensions, Distance distance) {
    Random random(11);
    int missed = 0;
    int met = 0;
    for (int k = 0; k < 400; ++k) {
        const Vec3 start = vec(random.point(1.5f));
        if (distance(start) < kThicknessOf) continue;
        const Vec3 end = vec(random.point(1.5f));
        Contact contact(end, dimensions);
        contact.rows[7].z = 0.0f;
        contact.previous[0] = {static_cast<float>(start.x), static_cast<float>(start.y),
                               static_cast<float>(start.z), 0.0f};
        const Vec3 pushed = contact.push(kernel);
        const double least = least_on_way(start, end, distance) - kThicknessOf;
        if (least > 1e-2) {
            ++missed;
            expect_at(pushed, end, 2e-6);
        }
        if (least < -1e-2) ++met;
        EXPECT_GT(least_on_way(start, pushed, distance), kThicknessOf - 1e-5) << "way " << k;
    }
    EXPECT_GT(missed, 50);
    EXPECT_GT(met, 50);
}

TEST(Obstacles, SweptOnesAreNeverPassed) {
    expect_swept(kernels::push_out_of_sphere, {0.5f, 0, 0, 0},
                 [](Vec3 p) { return length(p) - 0.5; });
    expect_swept(kernels::push_out_of_capsule, {0.25f, 1.0f, 0, 0}, [](Vec3 p) {
        return length(Vec3{p.x, p.y - std::clamp(p.y, -1.0, 1.0), p.z}) - 0.25;
    });
    expect_swept(kernels::push_out_of_box, {1.0f, 0.01f, 1.5f, 0}, [](Vec3 p) {
        return distance_from_box(p, {1.0, static_cast<double>(0.01f), 1.5});
    });
    expect_swept(kernels::push_out_of_plane, {}, [](Vec3 p) { return p.y; });
}

TEST(Obstacles, ThinOnesAreSweptByVerticesThatHaveGoneFar) {
    const auto pushed_from = [](double y) {
        Contact contact({0.0, -0.5, 0.0}, {1.0f, 0.01f, 1.0f, 0.0f});
        contact.previous[0].y = static_cast<float>(y);
        contact.rows[7].z = 0.75f * 0.75f;
        return contact.push(kernels::push_out_of_box).y;
    };
    EXPECT_DOUBLE_EQ(pushed_from(0.24), -0.5) << "0.74 m: as if it had come from below";
    EXPECT_NEAR(pushed_from(0.26), 0.135, 1e-6) << "0.76 m: it has come through";
}

TEST(Obstacles, SweptSphereThatFliesThroughAVertexTakesItAlong) {
    // From y = 50 to y = -50, past a vertex at rest half a radius beside its way: the tangent plane
    // of the first contact goes with the sphere.
    Contact contact({0.25, 0.0, 0.0}, {0.5f, 0, 0, 0});
    contact.rows[1].w = 50.0f;
    contact.rows[4].w = 50.0f;
    contact.rows[7] = {0.0f, 0.0f, 0.0f, 0.0f};
    const Vec3 x = contact.push(kernels::push_out_of_sphere);
    const Vec3 normal{0.5, -std::sqrt(0.75), 0.0};
    const Vec3 centre{0.0, -50.0, 0.0};
    EXPECT_NEAR(dot(x - centre, normal), 0.5, 1e-4);
    EXPECT_GE(length(x - centre), 0.5 - 1e-4);
    EXPECT_NEAR(length(cross(x - Vec3{0.25, 0.0, 0.0}, normal)), 0.0, 1e-4);
}

}  // namespace
}  // namespace weft::test
