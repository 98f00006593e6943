#include "simulation/model/load_paths.h"

#include <gtest/gtest.h>

#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
name = "sheet"
grid = { size = [1.0, 2.0], resolution = [11, 21] }
density = 0.2
stretch = { stiffness = 1.0e3 }
)";
const std::string kPins = "pins = { box = [[-1.0, -1.0, -1.001], [1.0, 1.0, -0.999]] }\n";
const std::string kBlock = R"(
[[solid]]
name = "block"
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
translate = [0.0, -0.1, 0.0]
density = 1000.0
young = 1.0e5
poisson = 0.3
)";
const std::string kTies = R"(
[[attachment]]
a = "block"
b = "sheet"
faces = ["y+"]
stiffness = 100.0
)";

std::vector<LoadPath> paths_of(const std::string& text, bool with_ties = false) {
    Warnings warnings;
    const Gathered all = gather(parse_scene(text, "test.toml"), warnings);
    std::vector<Stencils> links;
    for (const auto& family : all.families) {
        if (with_ties && family->stencils().arity == 2) links.push_back(family->stencils());
    }
    return load_paths(all, links);
}

Model model_of(const std::string& text, Warnings& warnings) {
    return {parse_scene(text, "test.toml"), warnings};
}

TEST(LoadPaths, RunFromTheFarthestVertexToThePins) {
    const auto paths = paths_of(kSheet + kPins);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].levels, 20.0);
    EXPECT_EQ(paths[0].burden, 1.0);
    EXPECT_FALSE(paths[0].is_solid);
    // Edges of 0.1 m along both sides, and diagonals.
    EXPECT_GT(paths[0].edge, 0.1);
    EXPECT_LT(paths[0].edge, 0.13);
}

TEST(LoadPaths, OfWhatNothingHoldsAreHalfOfItsLength) {
    const auto paths = paths_of(kSheet);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_GE(paths[0].levels, 10.0);
    EXPECT_LE(paths[0].levels, 15.0);
}

TEST(LoadPaths, TiedBodiesBurdenTheLightest) {
    EXPECT_EQ(paths_of(kSheet + kPins + kBlock).size(), 2U);
    const auto paths = paths_of(kSheet + kPins + kBlock + kTies, true);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].body, "sheet");
    EXPECT_NEAR(paths[0].burden, 8.4 / 0.4, 1e-9);
}

/// What pins hold all over carries nothing, however light it is.
TEST(LoadPaths, ThatAreHeldAllOverAreNotBurdened) {
    const std::string all_pinned = "pins = { box = [[-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]] }\n";
    const auto paths = paths_of(kSheet + all_pinned + kBlock + kTies, true);
    ASSERT_EQ(paths.size(), 1U);
    EXPECT_EQ(paths[0].body, "block");
    EXPECT_EQ(paths[0].burden, 1.0);
}

/// 1 m from its pins on, by edges of 0.1 m and diagonals; its volume is its surface times 0.0238 m.
TEST(LoadPaths, OfSolidsThatPinsHoldMayBeSlender) {
    const std::string beam = R"(
[scene]
frames = 1
dt = 0.02
[[solid]]
grid = { size = [1.0, 0.1, 0.1], resolution = [11, 2, 2] }
density = 20.0
young = 1.0e6
poisson = 0.3
)";
    const auto held = paths_of(beam + "pins = { faces = [\"x-\"] }\n");
    ASSERT_EQ(held.size(), 1U);
    EXPECT_NEAR(held[0].slender, held[0].levels * held[0].edge / (4.0 * 0.01 / 0.42), 1e-6);
    EXPECT_GT(held[0].slender, 10.0);
    EXPECT_EQ(paths_of(beam)[0].slender, 1.0);
    EXPECT_EQ(paths_of(kSheet + kPins)[0].slender, 1.0);
}

TEST(LoadPaths, StrainGrowsWithTheSquareOfTheStepAndFallsWithIterations) {
    const LoadPath path{"sheet", 20.0, 0.1, 1.0, false, true};
    const double strain = unfinished_strain(path, 0.01, 4, 10.0);
    EXPECT_NEAR(strain, 0.1, 1e-12);
    EXPECT_NEAR(unfinished_strain(path, 0.005, 4, 10.0), strain / 4.0, 1e-12);
    EXPECT_NEAR(unfinished_strain(path, 0.01, 8, 10.0), strain / 2.0, 1e-12);
}

TEST(Substeps, LeftOutAreChosenForTheMesh) {
    Warnings warnings;
    const Model coarse = model_of(kSheet + kPins, warnings);
    EXPECT_EQ(coarse.scene.substeps, 5);  // 0.0167 sqrt(2 * 9.81 * 20 / (8 * 0.114 * 0.005))
    EXPECT_DOUBLE_EQ(coarse.h, coarse.scene.dt / 5);
    Scene fine = parse_scene(kSheet + kPins, "test.toml");
    std::get<GridShape>(fine.cloths[0].shape).resolution = {21, 41};
    const Model model(fine, warnings);
    EXPECT_EQ(model.scene.substeps, 10) << "in proportion to the resolution";
    EXPECT_EQ(with_substeps(fine).substeps, model.scene.substeps);

    fine.dt = 1e-9;
    EXPECT_EQ(with_substeps(fine).substeps, 1);
    EXPECT_TRUE(warnings.empty());
}

TEST(Substeps, AreNeverLongerThanAShortTime) {
    Scene scene = parse_scene(kSheet, "test.toml");
    scene.gravity = {};
    Warnings warnings;
    EXPECT_GE(Model(scene, warnings).scene.substeps, 4);
}

TEST(Substeps, ThatAreTooFewAreWarnedOf) {
    Scene scene = parse_scene(kSheet + kPins, "test.toml");
    scene.substeps = 1;
    Warnings warnings;
    const Model few(scene, warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("'sheet' is too fine for scene.substeps = 1 of 8 iterations"),
              std::string::npos)
        << warnings[0];
    EXPECT_NE(warnings[0].find("5 substeps"), std::string::npos) << warnings[0];
    EXPECT_EQ(few.scene.substeps, 1) << "what is asked for is done";
    warnings.clear();
    scene.substeps = 2;
    const Model enough(scene, warnings);
    EXPECT_TRUE(warnings.empty());
}

/// Where things weigh less, less is left undone.
TEST(Substeps, AreWarnedOfByTheScenesOwnGravity) {
    Warnings warnings;
    const std::string one_step = "substeps = 1\n";
    const auto with = [&](const std::string& gravity) {
        std::string text = kSheet + kPins;
        text.insert(text.find("[[cloth]]"), one_step + "gravity = " + gravity + "\n");
        warnings.clear();
        const Model model = model_of(text, warnings);
        return !warnings.empty();
    };
    EXPECT_TRUE(with("[0.0, -98.1, 0.0]"));
    EXPECT_FALSE(with("[0.0, -0.0981, 0.0]"));
    EXPECT_FALSE(with("[0.0, 0.0, 0.0]"));
}

/// By their masses, xpbd's constraints move the light body; descent moves the heavy one by its own
/// equations.
TEST(Substeps, AreWarnedOfForBurdensOnlyByXpbd) {
    Scene scene = parse_scene(kSheet + kPins + kBlock + kTies, "test.toml");
    scene.substeps = 4;
    for (const Method method : {Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd}) {
        scene.solver.method = method;
        Warnings warnings;
        const Model model(scene, warnings);
        EXPECT_EQ(warnings.size(), method == Method::kXpbd ? 1U : 0U) << name_of(method);
    }
}

/// Nothing is stretched by its weight that only falls.
TEST(Substeps, AreNotWarnedOfInFreeFall) {
    Scene scene = parse_scene(kSheet, "test.toml");
    scene.substeps = 1;
    scene.solver.iterations = 1;
    Warnings warnings;
    const Model falls(scene, warnings);
    EXPECT_TRUE(warnings.empty());
    scene.contact = Contact{};
    const Model may_land(scene, warnings);
    EXPECT_EQ(warnings.size(), 1U);
}

}  // namespace
}  // namespace weft::test
