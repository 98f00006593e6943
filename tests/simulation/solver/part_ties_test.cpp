// Which bodies ties lead as wholes.

#include "simulation/solver/part_ties.h"

#include <gtest/gtest.h>

#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

/// Two sheets under a third one, each tied to the one above; the seam within the last one is none
/// of two parts.
std::string sheets(const std::string& pins) {
    return R"(
[scene]
frames = 1
dt = 0.02
substeps = 1
[[cloth]]
name = "top"
grid = { size = [0.2, 0.2], resolution = [3, 4] }
density = 0.2
stretch = { stiffness = 1e3 }
)" + pins + R"(
[[cloth]]
name = "middle"
grid = { size = [0.2, 0.2], resolution = [3, 5] }
translate = [0.0, -0.1, 0.0]
density = 0.2
stretch = { stiffness = 1e3 }
[[cloth]]
name = "last"
grid = { size = [0.2, 0.2], resolution = [3, 6] }
translate = [0.0, -0.2, 0.0]
density = 0.2
stretch = { stiffness = 1e3 }
[[attachment]]
a = "middle"
b = "top"
stiffness = 40
edges = ["x-"]
[[attachment]]
a = "last"
b = "middle"
stiffness = 20
edges = ["z+"]
[[seam]]
a = { cloth = "last", edges = ["x-"] }
b = { cloth = "last", edges = ["x+"] }
stiffness = 30
time = 0.1
)";
}

TieTable table_of(const std::string& text) {
    return find_part_ties(Model(parse_scene(text, "test.toml")));
}

TEST(PartTies, LeadWhatIsHeldByOthersAlone) {
    const TieTable table = table_of(sheets("pins = { edges = [\"z-\"] }"));
    ASSERT_EQ(table.vertices.size(), 2U);
    EXPECT_EQ(table.vertices[0].size() + table.vertices[1].size(), 33U);
    int pairs = 0;
    for (const PartTie& tie : table.ties) {
        if (tie.other_part == PartTie::kNone) {
            EXPECT_NEAR(tie.tie.stiffness, 40.0, 1e-4);
            continue;
        }
        ++pairs;
        EXPECT_NE(tie.other_part, tie.part);
        EXPECT_NEAR(tie.tie.rest, 0.1, 1e-6);
    }
    EXPECT_EQ(table.ties.size(), 5U + 6U);
    EXPECT_EQ(pairs, 6);
}

TEST(PartTies, LeadNothingThatHangsFree) { EXPECT_TRUE(table_of(sheets("")).ties.empty()); }

}  // namespace
}  // namespace weft::test
