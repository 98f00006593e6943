// Obstacles that are meshes: vertices of the model that are led.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "simulation/bodies/frame_files.h"
#include "simulation/bodies/mesh_files.h"
#include "simulation/checks/start_contacts.h"
#include "simulation/families/convert.h"
#include "simulation/model/contact_thickness.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft::test {
namespace {

std::string scene_with(const std::string& obstacles, const std::string& contact = "[contact]\n") {
    return R"(
[scene]
frames = 4
dt = 0.01
substeps = 3
[solver]
method = "vbd"
iterations = 2
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [5, 5] }
translate = [0, 5, 0]
density = 0.2
stretch = { stiffness = 100.0 }
)" + contact +
           obstacles;
}

const std::string kFunnel = R"(
[[obstacle]]
name = "funnel"
shape = "mesh"
cylinder = { radius = [0.5, 0.1], height = 0.4, resolution = [12, 4] }
translate = [0, 1, 0]
)";

std::string message_of(const std::string& text) {
    try {
        Warnings warnings;
        const Model model(parse_scene(text, "s.toml"), warnings);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

TEST(MeshObstacles, AreVerticesThatNothingMoves) {
    Warnings warnings;
    const Model model(parse_scene(scene_with(kFunnel), "s.toml"), warnings);
    ASSERT_EQ(model.bodies.size(), 2u);
    EXPECT_EQ(model.bodies[1].kind, "obstacle");
    EXPECT_EQ(model.bodies[1].first_vertex, 25);
    EXPECT_EQ(model.bodies[1].vertex_count, 48);
    EXPECT_EQ(model.triangles.size(), 32u + 72u);
    EXPECT_EQ(model.moving_pins, nullptr);
    for (int v = 0; v < model.vertex_count(); ++v) {
        EXPECT_EQ((*model.positions)[static_cast<std::size_t>(v)].w == 0.0f,
                  index(model.scene_vertex(v)) >= 25);
    }
    // Of the sheet alone: its edges are 1/4, and its diagonals longer.
    EXPECT_NEAR(model.scene.contact->thickness, 0.25 * 0.25 * (2.0 + std::sqrt(2.0)) / 3.0, 1e-6);
}

/// What is on both sides of a short edge is near, and should not push; a sliver's is no measure.
TEST(ContactThickness, IsLessThanTheShortestEdge) {
    const auto thickness_with = [](int layers) {
        const std::string text =
            "[scene]\nframes = 1\ndt = 0.01\n[contact]\n[[solid]]\n"
            "density = 100.0\nyoung = 1.0e5\npoisson = 0.3\n"
            "grid = { size = [1.0, 1.0, 1.0], resolution = [3, 3, " +
            std::to_string(layers) + "] }\n";
        Warnings warnings;
        return Model(parse_scene(text, "s.toml"), warnings).scene.contact->thickness;
    };
    EXPECT_GT(thickness_with(3), 0.25 * 0.5);
    EXPECT_NEAR(thickness_with(11), 0.9 * 0.1, 1e-6);
    const double of_slivers = thickness_with(201);
    EXPECT_GT(of_slivers, 0.02);
    EXPECT_LT(of_slivers, 0.06);
}

/// Bodies that start nearer than that would push each other off at once.
TEST(ContactThickness, IsLessThanBodiesAreApart) {
    const auto sheet = [](double height, double size) {
        return fmt::format(
            "[[cloth]]\ndensity = 0.2\nstretch = {{ stiffness = 1000.0 }}\n"
            "grid = {{ size = [{1}, {1}], resolution = [11, 11] }}\n"
            "translate = [0.0, {0}, 0.0]\n",
            height, size);
    };
    Warnings warnings;
    const auto thickness_with = [&](const std::string& contact, const std::string& bodies) {
        const std::string text = "[scene]\nframes = 1\ndt = 0.01\nsubsteps = 4\n[contact]\n";
        warnings.clear();
        return Model(parse_scene(text + contact + bodies, "s.toml"), warnings)
            .scene.contact->thickness;
    };
    const double good = thickness_with("", sheet(0.0, 1.0));
    EXPECT_GT(good, 0.025);
    EXPECT_NEAR(thickness_with("", sheet(0.0, 1.0) + sheet(0.03, 1.0)), good, 1e-9);
    EXPECT_NEAR(thickness_with("", sheet(0.0, 1.0) + sheet(0.02, 1.0)), 0.9 * 0.02, 1e-6);
    EXPECT_TRUE(warnings.empty());
    EXPECT_NEAR(thickness_with("", sheet(0.0, 1.0) + sheet(0.005, 1.0)), 0.4 * good, 1e-3);
    ASSERT_EQ(warnings.size(), 1u) << "a tenth of the edges is the least that it may be";
    EXPECT_NE(warnings[0].find("contact pushes them apart at once: 0.0045 m"), std::string::npos)
        << warnings[0];
    thickness_with("thickness = 0.02\n", sheet(0.0, 1.0) + sheet(0.02, 1.0));
    EXPECT_TRUE(warnings.empty());
    thickness_with("thickness = 0.02\n", sheet(0.0, 1.0) + sheet(0.015, 1.0));
    EXPECT_EQ(warnings.size(), 1u);
}

TEST(MeshObstacles, NeedContactAndOneShape) {
    EXPECT_NE(message_of(scene_with(kFunnel, "")).find("is touched by [contact] alone"),
              std::string::npos);
    EXPECT_NE(message_of(scene_with(kFunnel + "grid = { size = [1, 1], resolution = [2, 2] }\n"))
                  .find("needs exactly one of mesh, grid, cylinder, has 2"),
              std::string::npos);
    EXPECT_NE(message_of(scene_with(kFunnel + "friction = 0.3\n")).find("that of [contact]"),
              std::string::npos);
    std::string named = kFunnel;
    named.replace(named.find("\"funnel\""), 8, "\"sheet\"");
    EXPECT_NE(message_of(scene_with(named)).find("a cloth or solid has that name"),
              std::string::npos);
    EXPECT_NE(message_of(scene_with(kFunnel + "motion = { frames = \"none_*.obj\" }\n"))
                  .find("no file has such a name"),
              std::string::npos);
    EXPECT_NE(message_of(scene_with(kFunnel + "motion = { frames = \"none.obj\" }\n"))
                  .find("expected a *"),
              std::string::npos);
}

std::vector<Vec3> positions_after(const std::string& text, const std::string& devices, int frames) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = devices;
    options.calibrate = false;
    options.plan = PlanKind::kSingle;
    Simulation simulation(parse_scene(text, "s.toml"), options, warnings);
    for (int f = 0; f < frames; ++f) simulation.advance();
    const std::vector<float> xyz = simulation.positions();
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
        positions.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
    }
    return positions;
}

TEST(MeshObstacles, MoveAsTheirParentDoes) {
    const std::string text = scene_with(R"(
[[obstacle]]
name = "hip"
shape = "sphere"
center = [0, 1, 0]
radius = 0.01
motion = { velocity = [2.0, 0.0, 0.0] }
)" + kFunnel + "parent = \"hip\"\nmotion = { angular_velocity = 1000.0, axis = [0, 1, 0] }\n");
    const std::vector<Vec3> start = positions_after(text, "cpu/1", 0);
    const std::vector<Vec3> end = positions_after(text, "cpu/1", 4);
    const Frame map = Motion{.angular_velocity = 1000.0, .center = {0, 1, 0}}.displacement(0.04);
    for (std::size_t v = 25; v < start.size(); ++v) {
        EXPECT_LT(length(end[v] - (map.to_world(start[v]) + Vec3{0.08, 0, 0})), 1e-6);
    }
}

class FramesOfAnObstacle : public testing::Test {
protected:
    FramesOfAnObstacle() {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        for (const int frame : {0, 1, 2, 10}) write(frame, 3);
    }

    /// At (frame, 2 frame, 0), the larger the later.
    void write(int frame, int vertices) {
        std::ofstream file(folder_ / ("body_" + std::to_string(frame) + ".obj"));
        const double size = 1.0 + 0.5 * frame;
        const Vec3 corners[] = {{0, 0, 0}, {size, 0, 0}, {0, 0, size}, {0, size, 0}};
        for (int v = 0; v < vertices; ++v) {
            file << "v " << corners[v].x + frame << ' ' << corners[v].y + 2 * frame << ' '
                 << corners[v].z << '\n';
        }
        file << "f 1 2 3\n";
    }
    std::string scene(const std::string& motion) const {
        return scene_with("[[obstacle]]\nname = \"body\"\nshape = \"mesh\"\nmesh = \"" +
                          (folder_ / "body_0.obj").string() + "\"\ntranslate = [0, 0, 7]\n" +
                          "motion = { frames = \"" + (folder_ / "body_*.obj").string() + "\"" +
                          motion + " }\n");
    }

    std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / "weft_frames";
};

TEST_F(FramesOfAnObstacle, AreInTheOrderOfTheirNumbers) {
    const Scene read = parse_scene(scene(""), "s.toml");
    std::vector<std::string> names;
    for (const std::string& file : frame_files(read.mesh_obstacles[0])) {
        names.push_back(std::filesystem::path(file).filename().string());
    }
    EXPECT_EQ(names,
              (std::vector<std::string>{"body_0.obj", "body_1.obj", "body_2.obj", "body_10.obj"}));
    const auto meshes = mesh_files(read);
    ASSERT_EQ(meshes.size(), 2u);
    EXPECT_EQ(meshes[1].body, "obstacle.body.frames");
    EXPECT_EQ(meshes[1].files, frame_files(read.mesh_obstacles[0]));
}

TEST_F(FramesOfAnObstacle, MayHaveZerosInFront) {
    std::filesystem::rename(folder_ / "body_2.obj", folder_ / "body_0002.obj");
    const Scene read = parse_scene(scene(""), "s.toml");
    const std::vector<std::string> files = frame_files(read.mesh_obstacles[0]);
    ASSERT_EQ(files.size(), 4U);
    EXPECT_TRUE(files[2].ends_with("body_0002.obj"));
    EXPECT_TRUE(files[3].ends_with("body_10.obj"));
}

TEST_F(FramesOfAnObstacle, AreRefusedWithoutANumberOrWithTheSame) {
    const auto why = [&](const char* name) {
        std::filesystem::copy_file(folder_ / "body_0.obj", folder_ / name);
        std::string what;
        try {
            frame_files(parse_scene(scene(""), "s.toml").mesh_obstacles[0]);
        } catch (const UserError& error) {
            what = error.what();
        }
        std::filesystem::remove(folder_ / name);
        return what;
    };
    for (const char* name : {"body_final.obj", "body_1_old.obj", "body_-1.obj", "body_1.5.obj"}) {
        EXPECT_NE(why(name).find(name), std::string::npos) << name;
    }
    EXPECT_NE(why("body_001.obj").find("the same number"), std::string::npos);
    EXPECT_EQ(why("bod_x.obj"), "");
}

TEST_F(FramesOfAnObstacle, AreWarnedOfWhereOneIsMissing) {
    const auto warnings_of = [&] {
        Warnings warnings;
        warn_of_missing_frames(parse_scene(scene(""), "s.toml").mesh_obstacles[0], warnings);
        return warnings;
    };
    ASSERT_EQ(warnings_of().size(), 1U);
    EXPECT_NE(warnings_of()[0].find("number 3 is missing"), std::string::npos);
    std::filesystem::remove(folder_ / "body_10.obj");
    EXPECT_EQ(warnings_of().size(), 0U);
}

TEST_F(FramesOfAnObstacle, AreReachedAndThenHeld) {
    const auto corner = [&](const std::string& motion, int frames) {
        return positions_after(scene(motion), "cpu/1", frames)[26];
    };
    EXPECT_EQ(corner("", 0), (Vec3{1, 0, 7}));
    EXPECT_EQ(corner("", 1), (Vec3{2.5, 2, 7}));
    EXPECT_EQ(corner("", 3), (Vec3{16, 20, 7}));
    EXPECT_EQ(corner("", 4), (Vec3{16, 20, 7}));
    EXPECT_EQ(corner(", frame_time = 0.02", 1), (Vec3{1.75, 1, 7}));
    const std::vector<Vec3> one = positions_after(scene(""), "cpu/1", 2);
    EXPECT_EQ(positions_after(scene(""), "opencl:0/1", 2), one);
}

/// What they hit takes up their speed, which is no energy from nowhere: nobody may take the
/// obstacle for one that stands because it has no velocity of its own.
TEST_F(FramesOfAnObstacle, HaveNoVelocityThatIsTheSameForAll) {
    Warnings warnings;
    const Model led(parse_scene(scene(""), "s.toml"), warnings);
    EXPECT_FALSE(led.moving_pins->common_velocity(0.0, led.h, 3).has_value());
}

TEST_F(FramesOfAnObstacle, MustHaveTheSameVertices) {
    write(1, 4);
    EXPECT_NE(message_of(scene("")).find("body_1.obj: 4 vertices, and obstacle 'body' has 3"),
              std::string::npos);
}

std::string told_of_start(const std::string& text) {
    Warnings warnings;
    const Model model(parse_scene(text, "s.toml"), warnings);
    try {
        check_start_contacts(model, OnCrossing::kStop, warnings);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(MeshObstacles, AreLookedAtAtTheStart) {
    EXPECT_EQ(told_of_start(scene_with(kFunnel)), "");
    std::string through = kFunnel;
    through.replace(through.find("[0, 1, 0]"), 9, "[0, 5, 0]");
    EXPECT_NE(told_of_start(scene_with(through)).find("obstacle 'funnel' triangle"),
              std::string::npos);
    // Those that lead their own way may cross each other.
    std::string other = kFunnel;
    other.replace(other.find("\"funnel\""), 8, "\"other\"");
    EXPECT_EQ(told_of_start(scene_with(kFunnel + other + "rotate = [0, 0, 1, 30]\n")), "");
}

TEST(MeshObstacles, SwallowOnlyWhereTheyAreClosed) {
    const std::string path = testing::TempDir() + "weft_box.obj";
    std::ofstream(path) << "v -1 4 -1\nv 1 4 -1\nv 1 4 1\nv -1 4 1\n"
                           "v -1 6 -1\nv 1 6 -1\nv 1 6 1\nv -1 6 1\n"
                           "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";
    const std::string box =
        "[[obstacle]]\nname = \"box\"\nshape = \"mesh\"\nmesh = \"" + path + "\"\n";
    EXPECT_NE(told_of_start(scene_with(box)).find("cloth 'sheet' lies inside obstacle 'box'"),
              std::string::npos);
    std::string open = kFunnel;
    open.replace(open.find("[0.5, 0.1]"), 10, "[0.9, 0.8]");
    open.replace(open.find("[0, 1, 0]"), 9, "[0, 5, 0]");
    EXPECT_EQ(told_of_start(scene_with(open)), "");
}

}  // namespace
}  // namespace weft::test
