#include <gtest/gtest.h>

#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

/// What is said of a sheet of 9 vertices, 3 in a row, that is held by these pins.
Warnings warnings_of(const std::string& pins) {
    const Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.01
substeps = 10
[[cloth]]
name = "sheet"
grid = { size = [1.0, 1.0], resolution = [3, 3] }
density = 0.2
stretch = { stiffness = 1.0e3 }
)" + pins,
                                    "test.toml");
    Warnings warnings;
    const Model model(scene, warnings);
    return warnings;
}

const std::string kStay = "[[cloth.pins]]\nvertices = [0, 1, 2]\n";
const std::string kGo = "[[cloth.pins]]\nvertices = [2, 5]\nmotion = { velocity = [1, 0, 0] }\n";
const std::string kTurn =
    "[[cloth.pins]]\nvertices = [5, 8]\nmotion = { angular_velocity = 9.0 }\n";

TEST(SharedPins, AreTold) {
    EXPECT_EQ(warnings_of(kStay + kGo),
              Warnings{"1 of the vertices of cloth 'sheet' are held by several pins that move "
                       "differently (the first: 2): each follows the last of these that has a "
                       "motion, and no other"});
    EXPECT_EQ(warnings_of(kGo + kStay), warnings_of(kStay + kGo));
    ASSERT_EQ(warnings_of(kStay + kGo + kTurn).size(), 1U);
    EXPECT_NE(warnings_of(kStay + kGo + kTurn)[0].find("2 of the vertices"), std::string::npos);
}

TEST(SharedPins, ThatMoveAlikeAreNoMatter) {
    EXPECT_EQ(warnings_of(kStay + kStay), Warnings{});
    EXPECT_EQ(warnings_of(kGo + kGo), Warnings{});
    EXPECT_EQ(warnings_of(kStay + kTurn), Warnings{});
}

}  // namespace
}  // namespace weft::test
