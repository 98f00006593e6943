#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/contact/fill.h"
#include "kernels/contact/truncate.h"
#include "runtime/row_table.h"
#include "simulation/mesh/vec3.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kSoft = 0.002f;
constexpr float kHard = 0.0005f;
constexpr double kRounding = 1e-6;

Vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

/// Of one that moves.
float4 end_of(const float4& anchor, Vec3 way) {
    return {anchor.x + static_cast<float>(way.x), anchor.y + static_cast<float>(way.y),
            anchor.z + static_cast<float>(way.z), 1.0f};
}

/// One vertex with planes of its own.
struct Cut {
    Vec3 at;
    bool is_cut = false;
    bool is_lost = false;
};

/// all_from: the iteration, counted from this one, from which on the ball alone is a reason
Cut truncate(const float4& anchor, Vec3 way, const std::vector<float4>& planes, int all_from = 0) {
    Buffer<int> begin("strips", 2);
    begin[1] = 1;
    RowTable table("planes", {&begin, 0, 1, 1}, static_cast<int>(planes.size()));
    auto& column = table.add_column<float4>("planes");
    Buffer<float4> positions("positions", 1);
    Buffer<float4> anchors("anchors", 1);
    Buffer<float> least("least", 1);
    Buffer<int> cut("cut", 1);
    anchors[0] = anchor;
    positions[0] = end_of(anchor, way);
    least[0] = 1e30f;
    table.counts()[0] = static_cast<int>(planes.size());
    for (std::size_t k = 0; k < planes.size(); ++k) {
        column[RowTable::kStride * k] = planes[k];
        least[0] = std::min(least[0], planes[k].w);
    }
    const Launch one =
        launch(kernels::truncate_contacts, Segments{}, positions, anchors, least, table.rows(),
               table.counts(), column, cut, kSoft, kHard, kIteration, all_from);
    run_on_host(one, one.kernel->scalar, 0, 1);
    return {vec(positions[0]) - vec(anchors[0]), cut[0] == 1, cut[0] == 2};
}

Cut hold_in_ball(const float4& anchor, Vec3 way) {
    Buffer<float4> positions("positions", 1);
    Buffer<float4> anchors("anchors", 1);
    Buffer<int> cut("cut", 1);
    anchors[0] = anchor;
    positions[0] = end_of(anchor, way);
    const Launch one =
        launch(kernels::hold_in_balls, Segments{}, positions, anchors, cut, kIteration, 0);
    run_on_host(one, one.kernel->scalar, 0, 1);
    return {vec(positions[0]) - vec(anchors[0]), cut[0] == 1, cut[0] == 2};
}

TEST(Truncation, LeavesAloneWhatIsAllowed) {
    const Cut end = truncate({0, 0, 0, 0.1f}, {0.003, -0.01, 0.002}, {{0, 1, 0, 0.02f}});
    EXPECT_FALSE(end.is_cut);
    EXPECT_EQ(end.at.y, static_cast<double>(-0.01f));
}

TEST(Truncation, StopsBeforeAPlaneAndLetsSlideAlongIt) {
    const Cut end = truncate({0, 0, 0, 0.1f}, {0.03, -0.05, 0.02}, {{0, 1, 0, 0.02f}});
    EXPECT_TRUE(end.is_cut);
    EXPECT_NEAR(end.at.y, -(0.02 - double{kSoft}), 1e-5);
    EXPECT_NEAR(end.at.x, 0.03, kRounding) << "what leads along the plane stays";
    EXPECT_NEAR(end.at.z, 0.02, kRounding);
}

TEST(Truncation, ExactlyOnThePlaneThereIsNoWayOnAndAllWaysAway) {
    const float4 plane{0, 1, 0, 0.0f};
    EXPECT_NEAR(truncate({0, 0, 0, 0.1f}, {0.03, -0.05, 0}, {plane}).at.y, 0.0, 1e-5);
    EXPECT_NEAR(truncate({0, 0, 0, 0.1f}, {0.03, -0.05, 0}, {plane}).at.x, 0.03, kRounding);
    EXPECT_NEAR(truncate({0, 0, 0, 0.1f}, {0.03, 0.05, 0}, {plane}).at.y, 0.05, kRounding);
}

TEST(Truncation, TheStrictestPlaneCounts) {
    const Cut end = truncate({0, 0, 0, 1.0f}, {0, -0.5, 0},
                             {{0, 1, 0, 0.3f}, {0, 1, 0, 0.02f}, {0, 1, 0, 0.2f}});
    EXPECT_NEAR(end.at.y, -(0.02 - double{kSoft}), 1e-4);
}

TEST(Truncation, KeepsToItsBall) {
    const Cut end = truncate({0, 0, 0, 0.05f}, {0.3, 0.4, 0}, {});
    EXPECT_TRUE(end.is_cut);
    EXPECT_NEAR(length(end.at), 0.05, kRounding);
    EXPECT_NEAR(end.at.x, 0.03, kRounding);
}

/// Strips that touch nothing have a kernel of their own.
TEST(Truncation, WhereNothingTouchesBallsHoldAlike) {
    Random random(3);
    constexpr int kAll = 64;
    int cut_ones = 0;
    for (int i = 0; i < kAll; ++i) {
        float4 anchor = random.point(1.0f);
        anchor.w = random.real(0.0f, 0.3f);
        const Vec3 way = vec(random.point(0.3f));
        const Cut by_planes = truncate(anchor, way, {});
        const Cut by_ball = hold_in_ball(anchor, way);
        EXPECT_EQ(by_ball.at, by_planes.at);
        EXPECT_EQ(by_ball.is_cut, by_planes.is_cut);
        cut_ones += by_ball.is_cut ? 1 : 0;
    }
    EXPECT_GT(cut_ones, kAll / 4);
    EXPECT_LT(cut_ones, kAll);
}

/// A wedge of up to 12 planes; some of them at the vertex.
std::vector<float4> random_planes(Random& random, float farthest) {
    std::vector<float4> planes;
    for (int k = random.integer(1, 12); k > 0; --k) {
        float4 n = random.point(1.0f);
        const float size = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) + 1e-6f;
        planes.push_back({n.x / size, n.y / size, n.z / size,
                          random.integer(0, 3) == 0 ? 0.0f : random.real(0.0f, farthest)});
    }
    return planes;
}

void expect_before(const std::vector<float4>& planes, Vec3 end) {
    for (const float4& plane : planes) {
        const double room = std::max(double{plane.w} - double{kHard}, 0.0);
        EXPECT_GT(dot(vec(plane), end), -room - kRounding);
    }
}

/// Whatever is asked for, all planes hold, and the ball.
TEST(Truncation, BallsWithoutPlanesWait) {
    constexpr int kLater = 1;
    const float4 anchor{0, 0, 0, 0.01f};
    const Cut waits = truncate(anchor, {0.02, 0, 0}, {}, kLater);
    EXPECT_FALSE(waits.is_cut);
    EXPECT_EQ(waits.at.x, static_cast<double>(0.02f));
    const Cut has_a_plane = truncate(anchor, {0.02, 0, 0}, {{0, 1, 0, 0.02f}}, kLater);
    EXPECT_FALSE(has_a_plane.is_cut);  // nobody asks before all are held
    EXPECT_NEAR(has_a_plane.at.x, 0.01, kRounding);
}

TEST(Truncation, HoldsBeforeAnyPlanes) {
    Random random(5);
    for (int trial = 0; trial < 3000; ++trial) {
        const auto planes = random_planes(random, 0.02f);
        const float4 way = random.point(0.1f);
        const Cut end = truncate({0, 0, 0, 0.03f}, vec(way), planes);
        EXPECT_LT(length(end.at), 0.03 + kRounding);
        expect_before(planes, end.at);
    }
}

/// Planes that a vertex has no row entries for hold as well.
TEST(Truncation, HoldsBeforeThoseOutOfReach) {
    constexpr float kRadius = 0.03f;
    const kernels::contact_settings settings{0.004f, kSoft, 1.0f};
    const float farthest = kernels::out_of_reach(kRadius, settings);
    Random random(7);
    std::size_t left_out = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const auto planes = random_planes(random, 2.0f * kRadius);
        auto within = planes;
        left_out += std::erase_if(within, [=](const float4& p) { return p.w >= farthest; });
        expect_before(planes, truncate({0, 0, 0, kRadius}, vec(random.point(0.1f)), within).at);
    }
    EXPECT_GT(left_out, 3000U);
}

TEST(Truncation, DoesNotDependOnThePlace) {
    const std::vector<float4> planes{{0, 1, 0, 0.02f}, {0.6f, 0.8f, 0, 0.01f}};
    const Cut here = truncate({0, 0, 0, 0.1f}, {0.03125, -0.0625, 0.015625}, planes);
    const Cut there = truncate({8, -4, 2, 0.1f}, {0.03125, -0.0625, 0.015625}, planes);
    EXPECT_NEAR(length(here.at - there.at), 0.0, 2e-6);
}

/// What the scene leads over a vertex' place pushes it along.
TEST(Truncation, MakesWayForAPlaneThatComes) {
    const Cut still = truncate({0, 0, 0, 0.1f}, {0, 0, 0}, {{0, 1, 0, -0.03f}});
    EXPECT_TRUE(still.is_cut);
    EXPECT_NEAR(still.at.y, 0.03, 1e-5);
    const Cut along =
        truncate({0, 0, 0, 0.1f}, {0.05, -0.02, 0}, {{0, 1, 0, -0.03f}, {0, -1, 0, 0.05f}});
    EXPECT_NEAR(along.at.y, 0.03, 1e-4);
    EXPECT_NEAR(along.at.x, 0.05, 1e-4);
}

/// Where one comes over it that another one does not let it give way to, it is lost, however little
/// is missing: nothing stays between it and what is led.
TEST(Truncation, IsLostWhereTwoPlanesLeaveNoRoom) {
    const auto between = [](float room) {
        return truncate({0, 0, 0, 0.1f}, {0, 0, 0}, {{0, 1, 0, -0.03f}, {0, -1, 0, 0.03f + room}});
    };
    EXPECT_TRUE(between(-0.25f * kHard).is_lost);
    EXPECT_TRUE(between(-0.02f * kHard).is_lost);
    EXPECT_FALSE(between(kHard).is_lost);
}

constexpr float kReserve = 0.004f;

/// Where planes end: B begins at 0 and A at the distance, both come nearer by what they are led.
TEST(Planes, EndBeforeWhatTheSceneLeads) {
    Random random(6);
    constexpr float kDistance = 0.01f;
    for (int trial = 0; trial < 3000; ++trial) {
        const float led = random.real(0.0f, 5.0f * kDistance);
        const float own = random.real(0.0f, 5.0f * kDistance);
        const float least = random.real(1e-4f, 0.25f * kDistance);
        const float before_b = kernels::plane_end(kDistance, own, led, 0.0f, led, least, kReserve);
        EXPECT_GT(before_b, led) << "B goes there";
        const float before_a = kernels::plane_end(kDistance, led, own, led, 0.0f, least, kReserve);
        EXPECT_LT(before_a, kDistance - led) << "A goes there";
        const float free = kernels::plane_end(kDistance, own, led, 0.0f, 0.0f, least, kReserve);
        EXPECT_GT(free, 0.0f);
        EXPECT_LT(free, kDistance);
    }
}

/// And what has to give way keeps its distance, whatever its inertia asks for: gaps that shrink in
/// every substep are gone in the end.
TEST(Planes, KeepAReserveBeforeWhatTheSceneLeads) {
    constexpr float kLeast = 1e-4f;
    Random random(5);
    for (int trial = 0; trial < 3000; ++trial) {
        const float distance = random.real(0.1f * kReserve, 4.0f * kReserve);
        const float reserve = std::min(distance, kReserve);
        const float led = random.real(1e-6f, 0.05f);
        const float own = random.real(0.0f, 0.05f);
        const float kept = 0.949f * std::min(reserve, std::max(distance - led, reserve));
        const float before_b = kernels::plane_end(distance, own, led, 0.0f, led, kLeast, reserve);
        EXPECT_GT(before_b - led, kept);
        const float before_a = kernels::plane_end(distance, led, own, led, 0.0f, kLeast, reserve);
        EXPECT_GT(distance - led - before_a, kept);
    }
}

/// Whoever hardly moves keeps room to be pushed, or to swing, even if all that comes is the other.
TEST(Planes, LeaveBothSidesHalfOfWhatNobodyAsksFor) {
    constexpr float kDistance = 0.01f;
    const float still = kernels::plane_end(kDistance, 1e-5f, 0.0f, 0.0f, 0.0f, 1e-4f, kReserve);
    EXPECT_NEAR(still, 0.5f * (kDistance - 1e-5f), 1e-7f);
    const float both = kernels::plane_end(kDistance, 0.004f, 0.002f, 0.0f, 0.0f, 1e-4f, kReserve);
    EXPECT_NEAR(both, 0.004f, 1e-7f);
    const float fast = kernels::plane_end(kDistance, 0.04f, 0.01f, 0.0f, 0.0f, 1e-4f, kReserve);
    EXPECT_NEAR(fast, 0.2f * kDistance, 1e-7f) << "by how fast they come";
}

}  // namespace
}  // namespace weft::test
