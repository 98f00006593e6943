// What bodies do together is no matter of contact: piles fall freely, whatever lies between their
// layers. And what was not foreseen of a frame makes it run again, and nothing worse.

#include "simulation/contact/common_motion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kernels/contact/codes.h"
#include "simulation/contact/response.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

std::string head(int substeps, const std::string& gravity = "[0.0, -9.81, 0.0]") {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = {}
gravity = {}
[solver]
method = "vbd"
iterations = 5
[contact]
thickness = 0.001
)",
                       substeps, gravity);
}

std::string sheet(const std::string& name, double x, double y, const std::string& more = "") {
    return fmt::format(R"(
[[cloth]]
name = "{}"
grid = {{ size = [0.1, 0.1], resolution = [6, 6] }}
translate = [{}, {}, 0.0]
density = 0.2
stretch = {{ stiffness = 500.0 }}
{}
)",
                       name, x, y, more);
}

const std::string kHeld = "pins = { box = [[-9, -9, -9], [9, 9, 9]] }";

/// Free sheets over each other.
std::string pile(int count, double gap) {
    std::string text;
    for (int i = 0; i < count; ++i) text += sheet(fmt::format("sheet{}", i), 0.0, gap * i);
    return text;
}

Vec3 mean_of(const std::vector<float>& values, const BodyRange& body) {
    Vec3 sum;
    for (int v = 0; v < body.vertex_count; ++v) sum = sum + at(values, body.first_vertex + v);
    return (1.0 / body.vertex_count) * sum;
}

CommonMotion& motion_of(ManualRun& run) { return run.solver->contact()->motion(); }

/// u of a body in a substep [m], and w.
float4 carried(ManualRun& run, int substep, int body) {
    CommonMotion& motion = motion_of(run);
    return motion.carried()[static_cast<std::size_t>(substep * motion.body_count() + body)];
}

/// Lets all that is free begin with that velocity up.
void throw_free(ManualRun& run, float speed) {
    for (std::size_t v = 0; v < run.model->velocities->count(); ++v) {
        if ((*run.model->positions)[v].w > 0.0f) (*run.model->velocities)[v].y = speed;
    }
    run.changed(*run.model->velocities);
}

TEST(CommonMotion, LetsPilesFallFreely) {
    for (const int substeps : {10, 2}) {
        ManualRun run(parse_scene(head(substeps) + pile(5, 0.002), "test.toml"));
        run.run(60);
        const Fall fall = free_fall(run.model->scene, 0.0, 60);
        for (std::size_t i = 0; i < 5; ++i) {
            const double y = mean_of(positions(run), run.model->bodies[i]).y;
            EXPECT_NEAR(y - 0.002 * static_cast<double>(i), fall.x.y, 1e-3 * std::abs(fall.x.y));
        }
        EXPECT_EQ(run.unforeseen, 0);
    }
}

TEST(CommonMotion, IsThatOfGroups) {
    ManualRun run(parse_scene(head(4, "[0, 0, 0]") + sheet("a", 0.0, 0.0) + sheet("b", 0.0, 0.002) +
                                  sheet("c", 1.0, 0.0) + sheet("floor", 2.0, 0.0, kHeld) +
                                  sheet("d", 2.0, 0.002),
                              "test.toml"));
    const std::vector<double> speeds{3.0, 1.0, -2.0, 0.0, 5.0};
    for (std::size_t v = 0; v < run.model->velocities->count(); ++v) {
        const int body = motion_of(run).body_of()[v];
        (*run.model->velocities)[v].y = static_cast<float>(speeds[static_cast<std::size_t>(body)]);
    }
    motion_of(run).place(0.0);
    const double h = run.model->h;
    for (int substep = 0; substep < 4; ++substep) {
        EXPECT_NEAR(static_cast<double>(carried(run, substep, 0).y), 2.0 * h, 1e-6) << "the mean";
        EXPECT_EQ(carried(run, substep, 1).y, carried(run, substep, 0).y);
        EXPECT_NEAR(static_cast<double>(carried(run, substep, 2).y), -2.0 * h, 1e-6) << "alone";
        EXPECT_EQ(carried(run, substep, 4).y, 0.0f) << "too near to what is held";
    }
}

/// In a frame, a pile that falls is one with the floor only when it gets there.
TEST(CommonMotion, EndsWhereSomethingHeldIsReached) {
    ManualRun run(
        parse_scene(head(10) + pile(2, 0.002) + sheet("floor", 0.0, -0.1, kHeld), "test.toml"));
    throw_free(run, -9.0f);
    motion_of(run).place(0.0);
    EXPECT_LT(carried(run, 0, 0).y, -0.014f);
    EXPECT_LT(carried(run, 3, 0).y, -0.014f);
    EXPECT_EQ(carried(run, 9, 0).y, 0.0f);
}

TEST(CommonMotion, WhatTheSceneLeadsPushesOnlyWhatIsNear) {
    const std::string led =
        "pins = { box = [[-9, -9, -9], [9, 9, 9]], motion = { velocity = [0, "
        "1.0, 0] } }";
    ManualRun run(parse_scene(head(10) + sheet("bat", 0.0, -0.02, led) + sheet("near", 0.0, 0.0) +
                                  sheet("over", 0.0, 0.004) + sheet("far", 1.0, 0.0),
                              "test.toml"));
    motion_of(run).place(0.0);
    const double way = 1.0 * run.model->h;
    EXPECT_NEAR(static_cast<double>(carried(run, 0, 1).w), way, 1e-3 * way);
    EXPECT_EQ(carried(run, 0, 2).w, carried(run, 0, 1).w) << "by what is between";
    EXPECT_EQ(carried(run, 0, 3).w, 0.0f);
}

/// A sheet that is held out of its shape springs back into one that falls past.
TEST(CommonMotion, WhatIsUnforeseenRunsAgain) {
    ManualRun run(
        parse_scene(head(20) + sheet("spring", 0.0, 0.0) + sheet("passer", 0.2, 0.0), "test.toml"));
    const auto range = run.model->bodies[0];
    for (int v = 0; v < range.vertex_count; ++v) {
        float4& x = (*run.model->positions)[static_cast<std::size_t>(
            run.model->strips.rank[static_cast<std::size_t>(v)])];
        x.x = 3.0f * x.x;
        x.y = 0.004f * static_cast<float>(v % 7);
    }
    run.changed(*run.model->positions);
    throw_free(run, -5.0f);
    run.run(2);
    EXPECT_GE(run.unforeseen, 1);
}

TEST(BodyGroups, AreListedFromTheirFirstBodyOn) {
    BodyGroups groups(2, {{0}, {2}, {1, 3}, {4}});
    const std::vector<Vec3> centres(5);
    groups.place(0, {0, 1, 2, 2, 4}, centres);
    groups.place(1, {0, 1, 0, 3, 4}, centres);
    const auto list = [&](const Buffer<int>& b, int substep) {
        const auto first = b.span().begin() + 4 * groups.level_count() * substep;
        return std::vector<int>(first, first + 4);
    };
    EXPECT_EQ(list(groups.leaders, 0), (std::vector{0, 1, 1, 3})) << "3 and 1 are one";
    EXPECT_EQ(list(groups.leaders, 1), (std::vector{0, 0, 2, 3}));
    EXPECT_EQ(list(groups.counts, 0), (std::vector{1, 2, 0, 1}));
    EXPECT_EQ(list(groups.counts, 1), (std::vector{2, 0, 1, 1}));
    for (const int substep : {0, 1}) {
        const auto leaders = list(groups.leaders, substep);
        EXPECT_EQ(list(groups.members, substep), (std::vector{0, 1, 2, 3}));
        for (const int leader : leaders) {
            const int first = list(groups.firsts, substep)[static_cast<std::size_t>(leader)];
            EXPECT_EQ(list(groups.members, substep)[static_cast<std::size_t>(first)], leader);
        }
    }
}

TEST(BodyGroups, HaveHalvesOnBothSidesOfTheMiddleOfTheirLongestSide) {
    BodyGroups groups(1, {{0}, {1}, {2}, {3}, {4}});
    const std::vector<Vec3> centres{{0, 3, 0}, {9, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 2, 0}};
    groups.place(0, {0, 1, 0, 0, 0}, centres);
    const auto leaders = groups.leaders.span();
    EXPECT_EQ(std::vector<int>(leaders.begin(), leaders.begin() + 5), (std::vector{0, 1, 0, 0, 0}));
    EXPECT_EQ(std::vector<int>(leaders.begin() + 5, leaders.end()), (std::vector{0, 1, 2, 2, 0}));
}

TEST(BodyGroups, OfManyBodiesHavePartsOfAFew) {
    const auto levels_of = [](std::size_t bodies) {
        return BodyGroups(1, std::vector<std::vector<int>>(bodies)).level_count();
    };
    EXPECT_EQ(levels_of(1), 2);
    EXPECT_EQ(levels_of(15), 2);
    EXPECT_EQ(levels_of(16), 3);
    EXPECT_EQ(levels_of(50), 4);
    EXPECT_EQ(levels_of(100'000), WEFT_MOST_GROUP_LEVELS);

    constexpr int kBodies = 16;
    std::vector<std::vector<int>> parts;
    std::vector<Vec3> stack;
    for (int b = 0; b < kBodies; ++b) {
        parts.push_back({b});
        stack.push_back({0.0, 0.1 * b, 0.0});
    }
    BodyGroups groups(1, parts);
    groups.place(0, std::vector<int>(kBodies), stack);
    for (std::size_t b = 0; b < kBodies; ++b) {
        EXPECT_EQ(groups.leaders[b], 0);
        EXPECT_EQ(groups.leaders[kBodies + b], static_cast<int>(b) / 8 * 8);
        EXPECT_EQ(groups.leaders[2 * kBodies + b], static_cast<int>(b) / 4 * 4);
    }
}

}  // namespace
}  // namespace weft::test
