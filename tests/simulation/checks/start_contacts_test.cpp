#include "simulation/checks/start_contacts.h"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/error.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

const std::string kHead = R"(
[scene]
frames = 1
dt = 0.01
substeps = 1
)";

std::string sheet(const std::string& name, const std::string& place,
                  const std::string& resolution = "[9, 9]") {
    return "[[cloth]]\nname = \"" + name +
           "\"\ngrid = { size = [1.0, 1.0], resolution = " + resolution +
           " }\ndensity = 0.2\nstretch = { stiffness = 100.0 }\n" + place + "\n";
}

std::string block(const std::string& name, const std::string& size, const std::string& place = "") {
    return "[[solid]]\nname = \"" + name + "\"\ngrid = { size = " + size +
           ", resolution = [4, 4, 4] }\ndensity = 100.0\nyoung = 1e4\npoisson = 0.3\n" + place +
           "\n";
}

struct Told {
    std::string error;
    Warnings warnings;
};

Told told_of(const std::string& bodies, OnCrossing on_crossing = OnCrossing::kStop,
             const std::string& contact = "thickness = 0.02") {
    Warnings of_scene;
    const Model model(parse_scene(kHead + bodies + "[contact]\n" + contact + "\n", "s.toml"),
                      of_scene);
    Told told;
    try {
        check_start_contacts(model, on_crossing, told.warnings);
    } catch (const UserError& error) {
        told.error = error.what();
    }
    return told;
}

void expect_silence(const std::string& bodies, const std::string& contact = "thickness = 0.02") {
    const Told told = told_of(bodies, OnCrossing::kStop, contact);
    EXPECT_EQ(told.error, "");
    EXPECT_EQ(told.warnings, Warnings{});
}

constexpr const char* kUpright = "rotate = [0, 0, 1, 90]\ntranslate = [0.03, 0.02, 0.01]";

TEST(StartContacts, AreSilentWhereAllIsApart) {
    expect_silence(sheet("a", "") + sheet("b", "translate = [0, 0.0021, 0]") +
                   block("c", "[1, 1, 1]", "translate = [0, 0.6, 0]"));
}

TEST(StartContacts, NameTheTrianglesThatCross) {
    const std::string bodies = block("box", "[0.1, 0.1, 0.1]", "translate = [0, 3, 0]") +
                               sheet("a", "") + sheet("b", kUpright);
    const Told stop = told_of(bodies);
    EXPECT_NE(stop.error.find("s.toml: bodies cross at the start"), std::string::npos)
        << stop.error;
    EXPECT_NE(stop.error.find("pairs of triangles cross: cloth 'a' triangle "), std::string::npos);
    EXPECT_NE(stop.error.find(" and cloth 'b' triangle "), std::string::npos);
    EXPECT_NE(stop.error.find("--on-crossing warn"), std::string::npos);
    const Told warn = told_of(bodies, OnCrossing::kWarn);
    EXPECT_EQ(warn.error, "");
    ASSERT_GE(warn.warnings.size(), 1u);
    EXPECT_NE(warn.warnings[0].find("pairs of triangles cross"), std::string::npos);
}

/// The upright sheet meets both triangles of the cell of the other one with both of its own but
/// for one pair.
TEST(StartContacts, CountThePairs) {
    const Told told = told_of(sheet("a", "", "[2, 2]") +
                              sheet("b", "scale = 0.2\n" + std::string(kUpright), "[2, 2]"));
    EXPECT_NE(told.error.find("3 pairs of triangles cross: cloth 'a' triangle 0 and cloth 'b' "
                              "triangle 0; cloth 'a' triangle 1 and cloth 'b' triangle 0; cloth "
                              "'a' triangle 1 and cloth 'b' triangle 1;"),
              std::string::npos)
        << told.error;
}

TEST(StartContacts, PassOverWhatContactDoesNotLookAt) {
    const std::string held = "pins = { box = [[-9, -9, -9], [9, 9, 9]] }";
    expect_silence(sheet("a", held) + sheet("b", std::string(kUpright) + "\n" + held));
    const std::string cross = sheet("a", "", "[2, 2]") + sheet("b", kUpright, "[2, 2]");
    EXPECT_NE(told_of(cross).error, "");
}

/// Two sheets that are hinged to each other along an edge.
TEST(StartContacts, PassOverWhatIsTiedTogetherInOnePlace) {
    const std::string hinged =
        sheet("a", "") + sheet("b", "rotate = [1, 0, 0, 30]\ntranslate = [0, -0.25, -0.0669873]");
    EXPECT_EQ(told_of(hinged).warnings.size(), 1u) << "they touch";
    const auto tie = [](const std::string& at) {
        return "[[attachment]]\na = \"a\"\nb = \"b\"\n" + at + "\nstiffness = 1.0\n";
    };
    expect_silence(hinged + tie("edges = [\"z-\"]"));
    // But not whole triangles: edges cross between the ties.
    const std::string upon = sheet("a", "") + sheet("b", "") + tie("edges = [\"z-\"]");
    EXPECT_EQ(told_of(upon).error, "") << "tied along an edge alone";
    const std::string everywhere =
        sheet("a", "") + sheet("b", "") + tie("box = [[-9, -9, -9], [9, 9, 9]]");
    EXPECT_NE(told_of(everywhere).error.find("triangles lie upon what their corners are tied to"),
              std::string::npos)
        << told_of(everywhere).error;
    // What is tied at a distance still touches, and crosses.
    const std::string cross = sheet("a", "", "[2, 2]") + sheet("b", kUpright, "[2, 2]");
    EXPECT_EQ(told_of(cross + tie("vertices = [0, 1, 2, 3]")).error, told_of(cross).error);
}

TEST(StartContacts, OfABodyWithItselfOnlyIfItIsAskedFor) {
    const std::string path = testing::TempDir() + "cross.obj";
    std::ofstream(path) << "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 -1 -0.5\nv 0.1 1 -0.5\nv 0 1 0.5\n"
                           "f 1 2 3\nf 4 5 6\n";
    const std::string body = "[[cloth]]\nname = \"m\"\nmesh = \"" + path +
                             "\"\ndensity = 0.2\nstretch = { stiffness = 100.0 }\n";
    EXPECT_NE(told_of(body).error.find("cloth 'm' triangle 0 and cloth 'm' triangle 1"),
              std::string::npos);
    expect_silence(body, "thickness = 0.02\nself = false");
}

TEST(StartContacts, WarnOfWhatIsTooNear) {
    const Told near = told_of(sheet("a", "") + sheet("b", "translate = [0, 0.0015, 0]"));
    EXPECT_EQ(near.error, "");
    ASSERT_EQ(near.warnings.size(), 1u);
    EXPECT_NE(near.warnings[0].find("start nearer to each other than 0.002 m"), std::string::npos)
        << near.warnings[0];
    EXPECT_NE(near.warnings[0].find("the nearest at 0.0015 m"), std::string::npos);
    const Told same = told_of(sheet("a", "") + sheet("b", ""));
    EXPECT_EQ(same.error, "");
    ASSERT_EQ(same.warnings.size(), 1u);
    EXPECT_NE(same.warnings[0].find("the nearest at 0 m"), std::string::npos);
}

TEST(StartContacts, TellWhatIsInsideOfASolid) {
    const std::string bodies = block("box", "[1, 1, 1]") + sheet("hidden", "scale = 0.3");
    const Told told = told_of(bodies);
    EXPECT_NE(told.error.find("cloth 'hidden' lies inside solid 'box' (vertex 0)"),
              std::string::npos)
        << told.error;
    expect_silence(block("box", "[1, 1, 1]") +
                   sheet("beside", "scale = 0.3\ntranslate = [2, 0, 0]"));
}

}  // namespace
}  // namespace weft::test
