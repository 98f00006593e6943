// Where a model's positions count from.

#include "simulation/model/origin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

Gathered box_of(Vec3 middle, Vec3 size) {
    Gathered all;
    all.rest = {middle - 0.5 * size, middle + 0.5 * size};
    all.masses = {1.0, 1.0};
    return all;
}

TEST(Origin, IsZeroNearTheBodies) {
    EXPECT_EQ(origin_of(box_of({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0})), Vec3{});
    EXPECT_EQ(origin_of(box_of({8.0, -8.0, 8.0}, {1.0, 0.0, 1.0})), Vec3{});
    EXPECT_EQ(origin_of(box_of({7900.0, 0.0, 0.0}, {0.0, 1000.0, 0.0})), Vec3{});
}

TEST(Origin, IsTheNearestMultipleOfAPowerOfTwoAboveTheSize) {
    EXPECT_EQ(origin_of(box_of({10000.9, 0.0, 0.0}, {0.5, 1.0, 0.0})), (Vec3{10000.0, 0.0, 0.0}));
    EXPECT_EQ(origin_of(box_of({10001.1, 0.0, 0.0}, {0.5, 1.0, 0.0})), (Vec3{10002.0, 0.0, 0.0}));
    EXPECT_EQ(origin_of(box_of({0.0, 3.0, -9.0}, {0.1, 0.1, 0.1})), (Vec3{0.0, 3.0, -9.0}));
    EXPECT_EQ(origin_of(box_of({0.0, 0.0, -10e3}, {0.0, 0.0, 1e3})), (Vec3{0.0, 0.0, -10240.0}));
}

TEST(Origin, IsGivenByWhatHasMass) {
    Gathered all = box_of({10000.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
    all.rest.push_back({0.0, -3000.0, 0.0});
    all.masses.push_back(0.0);
    EXPECT_EQ(origin_of(all), (Vec3{10000.0, 0.0, 0.0}));
    EXPECT_EQ(origin_of(Gathered{}), Vec3{});
    EXPECT_EQ(origin_of(box_of({10000.0, 0.0, 0.0}, {})), Vec3{});  // a point
}

TEST(Origin, IsTakenFromAllPlaces) {
    Gathered all = box_of({10000.0, 0.0, 0.0}, {2.0, 2.0, 2.0});
    const Motion carrier{.center = {10000.5, 1.0, 0.0}};
    MovingPins::Group group;
    group.rest = {{10001.0, 1.0, 1.0}};
    group.frames = {{{10002.0, 0.0, 0.0}}};
    group.motion.center = {10001.0, 0.0, 0.0};
    group.motion.parent = std::make_shared<const Motion>(carrier);
    all.moving.push_back(group);
    count_from({10000.0, 0.0, 0.0}, all);
    EXPECT_EQ(all.origin, (Vec3{10000.0, 0.0, 0.0}));
    EXPECT_EQ(all.rest[1], (Vec3{1.0, 1.0, 1.0}));
    EXPECT_EQ(all.moving[0].rest[0], (Vec3{1.0, 1.0, 1.0}));
    EXPECT_EQ(all.moving[0].frames[0][0], (Vec3{2.0, 0.0, 0.0}));
    EXPECT_EQ(all.moving[0].motion.center, (Vec3{1.0, 0.0, 0.0}));
    EXPECT_EQ(all.moving[0].motion.parent->center, (Vec3{0.5, 1.0, 0.0}));
}

/// A motion that is counted from elsewhere leads every point as the motion itself.
TEST(Origin, KeepsMotionsAsTheyAre) {
    const Vec3 origin{64.0, -128.0, 32.0};
    Motion motion{
        .angular_velocity = 40.0, .axis = {1.0, 2.0, 0.5}, .center = {65.0, -127.0, 30.0}};
    motion.parent = std::make_shared<const Motion>(
        Motion{.velocity = {1.0, 2.0, 3.0}, .angular_velocity = 10.0, .center = {64.0, 0.0, 0.0}});
    const Vec3 place{63.0, -128.0, 33.0};
    const Vec3 as_given = motion.displacement(2.0).to_world(place);
    const Vec3 counted = counted_from(origin, motion).displacement(2.0).to_world(place - origin);
    EXPECT_LT(length(counted + origin - as_given), 1e-12);
}

/// Of a plane that is given by a point far away, friction needs one that is near.
TEST(Origin, GivesPlanesAPointNearby) {
    Obstacle plane;
    plane.shape = "plane";
    plane.frame = {{0.0, 0.0, 0.0}, rotation_matrix({0.0, 0.0, 1.0}, 30.0)};
    const Vec3 origin{1e4, 5e3, 0.0};
    const Obstacle counted = counted_from(origin, plane);
    for (const Vec3 point : {Vec3{1e4, 5e3, 0.0}, Vec3{1.1e4, 0.0, 20.0}}) {
        EXPECT_NEAR(distance_to(counted, point - origin, 0.0), distance_to(plane, point, 0.0),
                    2e-3);  // of single precision, at 10 km
    }
    const double height = 5e3 * std::cos(std::numbers::pi / 6) - 1e4 * 0.5;  // over the plane
    EXPECT_NEAR(length(counted.frame.origin), std::abs(height), 1e-9);
    EXPECT_EQ(counted_from({}, plane).frame, plane.frame);
}

/// Boxes that select are in the scene's own coordinates, whatever positions count from.
TEST(Origin, OfAModelIsThatOfItsBodies) {
    Warnings warnings;
    const Model model(parse_scene(R"(
[scene]
frames = 1
dt = 0.01
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [3, 3] }
translate = [-10000.25, 2.0, 1000.1]
density = 0.2
stretch = { stiffness = 100.0 }
pins = { box = [[-10000.75, 2.0, 999.5], [-10000.75, 2.0, 999.7]] }
[[obstacle]]
shape = "sphere"
center = [-10000.25, 1.0, 0.0]
radius = 0.5
[contact]
[[obstacle]]
shape = "mesh"
name = "floor"
grid = { size = [1.0, 1.0], resolution = [2, 2] }
)",
                                  "s.toml"),
                      warnings);
    EXPECT_EQ(model.origin, (Vec3{-10000.0, 0.0, 1000.0}));
    const auto local = model.in_scene_order(model.positions->span());
    EXPECT_EQ((std::vector<float>{local.begin(), local.begin() + 3}),
              (std::vector<float>{-0.75f, 2.0f, -0.4f}));
    EXPECT_EQ((*model.positions)[static_cast<std::size_t>(model.vertex(SceneVertex{0}))].w, 0.0f);
    EXPECT_EQ(model.convex_obstacles[0].frame.origin, (Vec3{-0.25, 1.0, -1000.0}));
    EXPECT_EQ(model.scene.obstacles[0].frame.origin, (Vec3{-10000.25, 1.0, 0.0}));
    EXPECT_EQ(local[3 * 9], 9999.5f);  // the floor's first vertex
    const auto there = model.in_scene(local);
    EXPECT_EQ(there[0], -10000.75f);
    EXPECT_EQ(there[2], static_cast<float>(999.6));
    EXPECT_EQ(there[3 * 9], -0.5f);
    const auto back = model.from_origin(there);
    for (std::size_t i = 0; i < local.size(); ++i) EXPECT_NEAR(back[i], local[i], 5e-4);
}

}  // namespace
}  // namespace weft::test
