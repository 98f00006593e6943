#include "simulation/scene/read_scene.h"

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "scene_text.h"

namespace weft {
namespace {

TEST(ReadScene, ReadsEveryPart) {
    const Scene scene = parse_scene(test::kFullScene, "dir/full.toml");
    EXPECT_EQ(scene.name, "full");
    EXPECT_EQ(scene.frames, 3);
    EXPECT_EQ(scene.dt, 0.02);
    EXPECT_EQ(scene.substeps, 2);
    EXPECT_EQ(scene.gravity, (Vec3{0.0, -9.81, 0.0}));
    EXPECT_EQ(scene.solver.iterations, 4);
    EXPECT_EQ(scene.guard.max_speed, 500.0);
    EXPECT_EQ(scene.guard.max_strain, Guard{}.max_strain);
    EXPECT_EQ(scene.text, test::kFullScene);
    ASSERT_EQ(scene.cloths.size(), 3U);
    ASSERT_EQ(scene.solids.size(), 1U);
    ASSERT_EQ(scene.attachments.size(), 1U);
    ASSERT_EQ(scene.obstacles.size(), 4U);
}

TEST(ReadScene, ReadsCloth) {
    const Scene scene = parse_scene(test::kFullScene, "full.toml");
    const Cloth& sheet = scene.cloths[0];
    EXPECT_EQ(std::get<GridShape>(sheet.shape).resolution, (std::array{5, 9}));
    EXPECT_EQ(sheet.transform.scale, (Vec3{0.5, 0.5, 0.5}));
    ASSERT_EQ(sheet.transform.rotations.size(), 1U);
    EXPECT_EQ(sheet.transform.rotations[0].degrees, 90.0);
    EXPECT_EQ(sheet.stretch.stiffness, 1e4);
    ASSERT_TRUE(sheet.bend);
    EXPECT_EQ(sheet.bend->stiffness, 1e-4);
    EXPECT_EQ(sheet.damping, 0.5);
    ASSERT_EQ(sheet.pins.size(), 1U);
    EXPECT_EQ(sheet.pins[0].corners.size(), 2U);

    const Cloth& tube = scene.cloths[1];
    EXPECT_EQ(std::get<CylinderShape>(tube.shape).radius, (std::array{0.2, 0.4}));
    ASSERT_EQ(tube.pins.size(), 2U);
    ASSERT_TRUE(tube.pins[0].motion);
    EXPECT_EQ(tube.pins[0].motion->keys.size(), 2U);
    EXPECT_FALSE(tube.pins[1].motion);
}

TEST(ReadScene, ReadsContact) {
    const std::string text = test::kFullScene;
    EXPECT_FALSE(parse_scene(text, "s.toml").contact);
    const Scene bare = parse_scene(text + "\n[contact]\n", "s.toml");
    ASSERT_TRUE(bare.contact);
    EXPECT_TRUE(bare.contact->self);
    EXPECT_EQ(bare.contact->thickness, 0.0);
    EXPECT_FALSE(bare.contact->friction);
    EXPECT_EQ(bare.contact->stiffness, Contact{}.stiffness);
    const Scene full = parse_scene(
        text + "\n[contact]\nself = false\nthickness = 3e-3\nfriction = 0.3\nstiffness = 2\n",
        "s.toml");
    EXPECT_FALSE(full.contact->self);
    EXPECT_EQ(full.contact->thickness, 3e-3);
    EXPECT_EQ(full.contact->friction, 0.3);
    EXPECT_EQ(full.contact->stiffness, 2.0);
}

TEST(ReadScene, MakesCopies) {
    const Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.01
[[cloth]]
name = "sheet"
grid = { size = [1, 1], resolution = [3, 3] }
density = 0.2
stretch = { stiffness = 100 }
translate = [0, 1, 0]
rotate = [1, 0, 0, 90]
copies = { count = 3, translate = [0, 0.5, 0.1], rotate = [0, 1, 0, 30] }
pins = { corners = ["x-z-"] }
[[cloth]]
grid = { size = [1, 1], resolution = [3, 3] }
density = 0.2
stretch = { stiffness = 100 }
)",
                                    "s.toml");
    ASSERT_EQ(scene.cloths.size(), 4U);
    const std::vector<std::string> names{"sheet", "sheet.1", "sheet.2", "cloth1"};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(scene.cloths[i].name, names[i]);
    const Cloth& last = scene.cloths[2];
    EXPECT_EQ(last.transform.translate, (Vec3{0, 2, 0.2}));
    ASSERT_EQ(last.transform.rotations.size(), 2U);
    EXPECT_EQ(last.transform.rotations[0].degrees, 90.0);
    EXPECT_EQ(last.transform.rotations[1].degrees, 60.0);
    EXPECT_EQ(last.pins.size(), 1U);
}

TEST(ReadScene, ReadsSolidsMembranesAndAttachments) {
    const Scene scene = parse_scene(test::kFullScene, "full.toml");
    const Solid& brick = scene.solids[0];
    EXPECT_EQ(std::get<BlockShape>(brick.shape).resolution, (std::array{4, 3, 2}));
    EXPECT_EQ(brick.density, 1000.0);
    EXPECT_EQ(brick.material.young, 1e5);
    EXPECT_EQ(brick.material.poisson, 0.45);
    EXPECT_EQ(brick.damping, 0.25);
    ASSERT_EQ(brick.pins.size(), 1U);
    EXPECT_EQ(brick.pins[0].faces, (std::vector<std::string>{"x-"}));
    EXPECT_EQ(brick.pins[0].corners, (std::vector<std::string>{"x+y+z+"}));

    const Cloth& film = scene.cloths[2];
    EXPECT_EQ(film.stretch.stiffness, 0.0);
    ASSERT_TRUE(film.membrane);
    EXPECT_EQ(film.membrane->material.poisson, 0.3);
    EXPECT_EQ(film.membrane->thickness, 1e-3);
    EXPECT_FALSE(scene.cloths[0].membrane);

    const Attachment& tie = scene.attachments[0];
    EXPECT_EQ(tie.a, "film");
    EXPECT_EQ(tie.b, "brick");
    EXPECT_EQ(tie.selected.corners, (std::vector<std::string>{"x-z-"}));
    EXPECT_EQ(tie.stiffness, 500.0);
    EXPECT_EQ(tie.reach, 3.0);
}

TEST(ReadScene, WhatIsNotNamedIsAbsent) {
    const Scene scene = parse_scene(test::kSmallScene, "dir/small.toml");
    EXPECT_EQ(scene.name, "small");
    EXPECT_EQ(scene.substeps, 0) << "the model's choice";
    EXPECT_EQ(scene.gravity, (Vec3{0.0, -9.81, 0.0}));
    EXPECT_TRUE(scene.gravity_keys.empty());
    EXPECT_TRUE(scene.obstacles.empty());
    ASSERT_EQ(scene.cloths.size(), 1U);
    EXPECT_EQ(scene.cloths[0].name, "cloth0");
    EXPECT_FALSE(scene.cloths[0].bend);
    EXPECT_FALSE(scene.cloths[0].damping);
    EXPECT_TRUE(scene.cloths[0].pins.empty());
}

TEST(ReadScene, WhatDoesNothingIsAbsent) {
    const Scene scene = parse_scene(test::kSmallScene + R"(
bend.stiffness = 0.0
damping = 0
pins = { corners = [] }
[[obstacle]]
shape = "sphere"
center = [0, 0, 0]
radius = 1
friction = 0
motion = { velocity = [0.0, 0.0, 0.0] }
)",
                                    "s.toml");
    EXPECT_FALSE(scene.cloths[0].bend);
    EXPECT_FALSE(scene.cloths[0].damping);
    EXPECT_TRUE(scene.cloths[0].pins.empty());
    EXPECT_FALSE(scene.obstacles[0].friction);
    EXPECT_FALSE(scene.obstacles[0].motion);
}

TEST(ReadScene, ObstaclesHaveFramesAndDimensions) {
    const Scene scene = parse_scene(test::kFullScene, "full.toml");
    const Obstacle& ball = scene.obstacles[0];
    EXPECT_EQ(ball.frame.origin, (Vec3{0.0, 0.5, 0.0}));
    EXPECT_EQ(ball.dimensions[0], 0.3);
    EXPECT_EQ(ball.frame_at(2.0).origin, (Vec3{2.0, 0.5, 0.0}));

    const Obstacle& plane = scene.obstacles[1];
    EXPECT_EQ(plane.name, "obstacle1");
    EXPECT_NEAR(plane.frame.to_local({3.0, 4.0, 5.0}).y, 5.0, 1e-12);

    const Obstacle& capsule = scene.obstacles[2];
    EXPECT_EQ(capsule.dimensions[1], 1.0);
    EXPECT_NEAR(length(capsule.frame.to_world({0.0, 1.0, 0.0}) - Vec3{2.0, 0.0, 0.0}), 0.0, 1e-12);

    const Obstacle& box = scene.obstacles[3];
    EXPECT_EQ(box.dimensions, (std::array{0.5, 1.0, 2.0, 0.0}));
    EXPECT_EQ(box.thickness, 0.01);
}

TEST(ReadScene, MeshIsRelativeToTheScene) {
    const std::string text =
        test::replaced(test::kSmallScene, "grid = { size = [1.0, 1.0], resolution = [3, 3] }",
                       "mesh = \"meshes/shirt.obj\"");
    const Scene scene = parse_scene(text, "scenes/s.toml");
    EXPECT_EQ(std::get<MeshFile>(scene.cloths[0].shape).path, "scenes/meshes/shirt.obj");
}

TEST(ReadScene, GravityFollowsItsKeys) {
    const Scene scene = parse_scene(
        test::replaced(test::kSmallScene, "dt = 0.01",
                       "dt = 0.01\ngravity_keyframes = [[1, 0, -10, 0], [2, 20, -10, 0]]"),
        "s.toml");
    EXPECT_EQ(scene.gravity_at(0.0), (Vec3{0.0, -10.0, 0.0}));
    EXPECT_EQ(scene.gravity_at(1.5), (Vec3{10.0, -10.0, 0.0}));
    EXPECT_EQ(scene.gravity_at(9.0), (Vec3{20.0, -10.0, 0.0}));
}

TEST(ReadScene, SizeScalesAllGeneratedBodies) {
    const Scene scene = parse_scene(test::kFullScene, "s.toml", {{"scene.size=100000", "--set"}});
    const auto grid = std::get<GridShape>(scene.cloths[0].shape).resolution;
    const auto tube = std::get<CylinderShape>(scene.cloths[1].shape).resolution;
    const auto film = std::get<GridShape>(scene.cloths[2].shape).resolution;
    const auto brick = std::get<BlockShape>(scene.solids[0].shape).resolution;
    EXPECT_NEAR(
        grid[0] * grid[1] + tube[0] * tube[1] + film[0] * film[1] + brick[0] * brick[1] * brick[2],
        100000, 1500);
    EXPECT_NEAR(static_cast<double>(grid[1]) / grid[0], 9.0 / 5.0, 0.02);
    EXPECT_NEAR(static_cast<double>(brick[0]) / grid[0], 4.0 / 5.0, 0.02);
}

TEST(ReadScene, SizeThatNothingFollowsIsRefused) {
    const std::string mesh = test::replaced(
        test::kSmallScene, "grid = { size = [1.0, 1.0], resolution = [3, 3] }", "mesh = 'a.obj'");
    const auto with_size = [](const std::string& text) {
        return parse_scene(text, "s.toml", {{"scene.size=1000", "--set"}});
    };
    std::string message;
    try {
        with_size(mesh);
    } catch (const UserError& error) {
        message = error.what();
    }
    EXPECT_EQ(message.find("--set: scene.size = 1000: no cloth or solid of the scene is a grid"),
              0U)
        << message;

    const std::string grid = test::kSmallScene.substr(test::kSmallScene.find("[[cloth]]"));
    const Scene both = with_size(mesh + grid);
    EXPECT_NEAR(std::get<GridShape>(both.cloths[1].shape).resolution[0], 32, 1);
}

TEST(ReadScene, SeveralRotationsAndBoxesAreLists) {
    const Scene scene = parse_scene(test::kSmallScene + R"(
rotate = [[1, 0, 0, 90], [0, 1, 0, 45]]
scale = [1, 2, 3]
pins.box = [[[-1, -1, -1], [0, 0, 0]], [[0, 0, 0], [1, 1, 1]]]
)",
                                    "s.toml");
    EXPECT_EQ(scene.cloths[0].transform.rotations.size(), 2U);
    EXPECT_EQ(scene.cloths[0].transform.scale, (Vec3{1, 2, 3}));
    EXPECT_EQ(scene.cloths[0].pins[0].boxes.size(), 2U);
}

}  // namespace
}  // namespace weft
