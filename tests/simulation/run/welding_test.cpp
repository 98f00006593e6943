// A mesh whose seams are welded is that of the same file with one vertex for two.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/error.h"
#include "simulation/families/convert.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/stitches/stitches.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/run/panels.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

class WeldedFiles {
protected:
    WeldedFiles() {
        const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
        name_ = "welding_" + test.substr(0, test.find('/')) + fmt::format("_{}", getpid());
        whole_ = write_obj(name_ + "_whole.obj", panels_.whole_obj());
        cut_ = write_obj(name_ + "_cut.obj", panels_.cut_obj());
    }
    ~WeldedFiles() {
        std::remove(whole_.c_str());
        std::remove(cut_.c_str());
    }

    /// cloth: more of its keys; more: tables behind it
    static std::string scene(const std::string& mesh, const std::string& cloth,
                             const std::string& more = "") {
        return fmt::format(R"(
[scene]
frames = 8
dt = 0.016666667
substeps = 4
[solver]
iterations = 5
[[cloth]]
name = "shirt"
mesh = "{}"
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
{}
{})",
                           mesh, cloth, more);
    }
    static Scene parsed(const std::string& text, Method method) {
        Scene scene = parse_scene(text, "test.toml");
        scene.solver.method = method;
        return scene;
    }
    std::string sewn(const std::string& mesh, const std::string& how) const {
        std::vector<int> left, right;
        for (const auto& [a, b] : panels_.cut) {
            left.push_back(a);
            right.push_back(b);
        }
        return scene(mesh, "",
                     fmt::format("[[seam]]\na = {{ cloth = \"shirt\", vertices = [{}] }}\n"
                                 "b = {{ cloth = \"shirt\", vertices = [{}] }}\n{}\n",
                                 fmt::join(left, ", "), fmt::join(right, ", "), how));
    }
    static std::string refusal(const std::string& text) {
        try {
            Warnings warnings;
            const Model model(parse_scene(text, "s.toml"), warnings);
        } catch (const UserError& error) {
            return error.what();
        }
        return "no error";
    }

    const Panels panels_ = Panels::make();
    std::string name_, whole_, cut_;
};

class Welding : public EverySolver, protected WeldedFiles {};
class WeldedSeams : public testing::Test, protected WeldedFiles {};

const char* const kStiff = "bend = { stiffness = 1.0e-4 }\ndamping = 0.5\n";

TEST_P(Welding, GivesTheBitsOfTheWholeMesh) {
    // What holds it, pulls at it and lies below: all that knows vertices by their numbers.
    const std::string pins = std::string(kStiff) + "pins = { vertices = [3, 7, 115] }\n";
    const std::string below =
        "[[obstacle]]\nshape = \"sphere\"\ncenter = [0.5, -0.25, 0.5]\nradius = 0.2\n"
        "[contact]\nthickness = 0.01\n";
    ManualRun whole(parsed(scene(whole_, pins, below), GetParam()));
    ManualRun welded(parsed(scene(cut_, pins + "weld = true\n", below), GetParam()));
    whole.run(8);
    welded.run(8);
    EXPECT_EQ(welded.hash(), whole.hash());
    EXPECT_EQ(welded.model->masses, whole.model->masses);
}

TEST_P(Welding, FallsFreely) {
    ManualRun run(parsed(scene(cut_, std::string(kStiff) + "weld = true\n"), GetParam()));
    const std::vector<float> before = positions(run);
    run.run(8);
    const Fall fall = free_fall(run.model->scene, 0.5, 8);
    const std::vector<float> after = positions(run);
    for (int v = 0; v < run.model->vertex_count(); ++v) {
        EXPECT_LT(length(at(after, v) - at(before, v) - fall.x), 1e-5) << v;
    }
}

TEST_P(Welding, PullsAtBothHalvesAlike) {
    Scene still = parsed(scene(cut_, "bend = { stiffness = 1.0e-4 }\nweld = true\n"), GetParam());
    still.gravity = {};
    // The angular momentum, as in physics_test.cpp.
    if (GetParam() != Method::kXpbd && GetParam() != Method::kNewton) {
        still.solver.iterations = 200;
    }
    ManualRun run(still);
    // Stretched along the seam and across it, and sheared out of its plane.
    auto& x = *run.model->positions;
    for (std::size_t v = 0; v < x.count(); ++v) {
        x[v] = {1.02f * x[v].x, x[v].y + 0.01f * x[v].x * x[v].z, 0.99f * x[v].z, x[v].w};
    }
    run.changed(x);
    EXPECT_GT(run_without_momentum(run, 8, 2e-3), 1e-3) << "it moves";
}

TEST_P(Welding, WholeAndWeldedHaveOnePattern) {
    // The pattern's halves lie apart: lengths and folds at rest are those of each triangle.
    const std::string pattern = write_obj(name_ + "_pattern.obj", panels_.cut_obj(0.4));
    const std::string keys = kStiff + fmt::format("rest = \"{}\"\n", pattern);
    ManualRun whole(parsed(scene(whole_, keys), GetParam()));
    ManualRun welded(parsed(scene(cut_, keys + "weld = true\n"), GetParam()));
    whole.run(4);
    welded.run(4);
    EXPECT_EQ(welded.hash(), whole.hash());
    std::remove(pattern.c_str());
}

TEST_F(WeldedSeams, SeamOfListedVerticesIsTheSame) {
    Warnings warnings;
    const Model whole(parse_scene(scene(whole_, ""), "s.toml"), warnings);
    for (const std::string& text : {sewn(cut_, "weld = true"), scene(cut_, "weld = true")}) {
        const Model welded(parse_scene(text, "s.toml"), warnings);
        EXPECT_EQ(welded.triangles, whole.triangles);
        EXPECT_EQ(welded.masses, whole.masses);
        EXPECT_EQ(welded.strips.order, whole.strips.order);
        EXPECT_EQ(welded.find<Stitches>(), nullptr);
        EXPECT_EQ(welded.find<Springs>()->count(), whole.find<Springs>()->count());
    }
    EXPECT_TRUE(warnings.empty());
}

TEST_F(WeldedSeams, VerticesKeepTheFilesNumbersInTheScene) {
    const auto [left, right] = panels_.cut.at(4);
    Warnings warnings;
    for (const int named : {left, right}) {
        const std::string keys = fmt::format("weld = true\npins = {{ vertices = [{}] }}\n", named);
        const Model model(parse_scene(scene(cut_, keys), "s.toml"), warnings);
        ASSERT_EQ(model.vertex_count(), static_cast<int>(panels_.positions.size()));
        for (int v = 0; v < model.vertex_count(); ++v) {
            const bool is_held = (*model.positions)[static_cast<std::size_t>(v)].w == 0.0f;
            EXPECT_EQ(is_held, model.scene_vertex(v) == SceneVertex{left}) << v;
        }
    }
    // Parts, ties and further seams, too.
    const std::string more = fmt::format(
        "[[cloth]]\nname = \"patch\"\ngrid = {{ size = [0.1, 0.1], resolution = [2, 2] }}\n"
        "density = 0.2\nstretch = {{ stiffness = 1.0e3 }}\n"
        "[[attachment]]\na = \"shirt\"\nb = \"patch\"\nvertices = [{}]\nstiffness = 10.0\n"
        "[[seam]]\na = {{ cloth = \"shirt\", vertices = [{}] }}\n"
        "b = {{ cloth = \"patch\", vertices = [0] }}\nstiffness = 10.0\ntime = 1.0\n",
        right, right);
    const Model model(parse_scene(scene(cut_, "weld = true\n", more), "s.toml"), warnings);
    const auto ends = model.find<Stitches>()->corners(0);
    EXPECT_TRUE(model.vertex(SceneVertex{left}) == ends[0] ||
                model.vertex(SceneVertex{left}) == ends[1]);
    const Springs& springs = *model.find<Springs>();
    int ties = 0;
    for (int s = 0; s < springs.count(); ++s) {
        const int a = static_cast<int>(model.scene_vertex(springs.corners(s)[0]));
        const int b = static_cast<int>(model.scene_vertex(springs.corners(s)[1]));
        const int patch = static_cast<int>(panels_.positions.size());
        if ((a < patch) != (b < patch)) {
            ++ties;
            EXPECT_EQ(std::min(a, b), left);
        }
    }
    EXPECT_EQ(ties, 1);
    const std::string keys =
        fmt::format("weld = true\npins = {{ vertices = [{}] }}\n", panels_.cut.back()[1] + 1);
    EXPECT_NE(refusal(scene(cut_, keys)).find("is out of range"), std::string::npos);
}

TEST_F(WeldedSeams, WhatIsApartIsRefused) {
    const std::string apart = write_obj(name_ + "_apart.obj", panels_.cut_obj(0.05));
    const std::string message = refusal(sewn(apart, "weld = true"));
    EXPECT_NE(message.find("s.toml:14:1: weld = true: vertex "), std::string::npos) << message;
    EXPECT_NE(message.find(" of cloth 'shirt' is 0.05 m away from vertex "), std::string::npos)
        << message;
    EXPECT_NE(message.find("Leave weld out, and give stiffness and time"), std::string::npos);
    Warnings warnings;
    const Model open(parse_scene(scene(apart, "weld = true"), "s.toml"), warnings);
    EXPECT_EQ(open.vertex_count(), static_cast<int>(panels_.positions.size() + panels_.cut.size()));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("no two vertices of the mesh's border lie in one place"),
              std::string::npos);
    std::remove(apart.c_str());
}

/// A seam of parts has to be together all around: a hem or a neck is not.
TEST_F(WeldedSeams, EveryBorderVertexOfBothEdgesNeedsAPartner) {
    const std::string parts =
        refusal(scene(cut_, "",
                      "[[seam]]\na = { cloth = \"shirt\", parts = [\"left\"] }\n"
                      "b = { cloth = \"shirt\", parts = [\"right\"] }\nweld = true\n"));
    EXPECT_NE(parts.find("only what lies together becomes one"), std::string::npos) << parts;
    const std::string inside =
        refusal(scene(cut_, "",
                      "[[seam]]\na = { cloth = \"shirt\", box = [[-0.5, -1, -1], [0.3, 1, 0.3]] }\n"
                      "b = { cloth = \"shirt\", box = [[0.08, -1, 0.18], [0.12, 1, 0.22]] }\n"
                      "weld = true\n"));
    EXPECT_NE(inside.find("has no edge of the cloth's border"), std::string::npos) << inside;
}

TEST_F(WeldedSeams, WrongWishesAreExplained) {
    EXPECT_NE(refusal(sewn(cut_, "weld = true\ntime = 0.5"))
                  .find("time = 0.5: cannot stand beside weld = true"),
              std::string::npos);
    EXPECT_NE(refusal(sewn(cut_, "stiffness = 1.0e3"))
                  .find("time: is missing: a seam has stiffness and time, or weld = true"),
              std::string::npos);
    EXPECT_NE(refusal(sewn(cut_, "weld = false\ntime = 1.0")).find("stiffness: is missing"),
              std::string::npos);
    const std::string grid =
        "[[cloth]]\nname = \"patch\"\ngrid = { size = [0.1, 0.1], resolution = [2, 2] }\n"
        "density = 0.2\nstretch = { stiffness = 1.0e3 }\n";
    EXPECT_NE(refusal(scene(cut_, "", grid + "weld = true\n")).find("only a mesh file has several"),
              std::string::npos);
    const std::string two =
        "[[seam]]\na = { cloth = \"shirt\", vertices = [1] }\n"
        "b = { cloth = \"patch\", vertices = [1] }\nweld = true\n";
    EXPECT_NE(refusal(scene(cut_, "", grid + two))
                  .find("joins edges of one cloth, and these are of 'shirt' and 'patch'"),
              std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Methods, Welding, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
