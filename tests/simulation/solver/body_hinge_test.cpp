// Where bodies are held, and whether that lets them turn.

#include "simulation/solver/body_hinge.h"

#include <gtest/gtest.h>

#include <vector>

#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

/// Of a sheet of 16 vertices, 4 in a row, turned somehow.
struct Sheet {
    Model model;
    BodyHinge hinge;

    explicit Sheet(const std::string& pins)
        : model(parse_scene(R"(
[scene]
frames = 1
dt = 0.01
substeps = 10
[[cloth]]
name = "sheet"
grid = { size = [1.0, 2.0], resolution = [4, 4] }
rotate = [1.0, 2.0, 3.0, 40.0]
translate = [0.3, 1.0, 2.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
)" + pins,
                            "test.toml")),
          hinge(hinge_of(model, held())) {}

    std::vector<int> held() const {
        std::vector<int> held;
        for (int v = 0; v < model.vertex_count(); ++v) {
            if ((*model.positions)[static_cast<std::size_t>(v)].w <= 0.0f) held.push_back(v);
        }
        return held;
    }
};

TEST(BodyHinge, IsALineOrAPoint) {
    for (const std::string corners : {R"("x-z-", "x+z-")", R"("x-z-", "x+z+")"}) {
        const Sheet sheet("pins = [ { corners = [" + corners + "] } ]\n");
        EXPECT_TRUE(sheet.hinge.can_turn) << corners;
        EXPECT_NE(sheet.hinge.from, sheet.hinge.to) << corners;
    }
    EXPECT_TRUE(Sheet("pins = [ { edges = [\"x-\"] } ]\n").hinge.can_turn);
    const Sheet corner("pins = [ { corners = [\"x-z-\"] } ]\n");
    EXPECT_TRUE(corner.hinge.can_turn);
    EXPECT_EQ(corner.hinge.from, corner.hinge.to);
}

TEST(BodyHinge, IsNoneWhereAnythingIsBeside) {
    EXPECT_FALSE(Sheet("pins = [ { corners = [\"x-z-\", \"x+z-\", \"x-z+\"] } ]\n").hinge.can_turn);
    EXPECT_FALSE(Sheet("pins = [ { edges = [\"x-\"], corners = [\"x+z-\"] } ]\n").hinge.can_turn);
}

TEST(BodyHinge, StaysOneWhereAllIsLedAlike) {
    const std::string turn = "motion = { angular_velocity = 90.0 }";
    EXPECT_TRUE(Sheet("pins = [ { edges = [\"x-\"], " + turn + " } ]\n").hinge.can_turn);
    const std::string apart = R"(
[[cloth.pins]]
vertices = [0]
motion = { velocity = [0, 1, 0] }
[[cloth.pins]]
vertices = )";
    EXPECT_TRUE(Sheet(apart + "[3]\n").hinge.can_turn) << "two are on a line wherever they are";
    EXPECT_FALSE(Sheet(apart + "[1, 2, 3]\n").hinge.can_turn);
}

}  // namespace
}  // namespace weft::test
