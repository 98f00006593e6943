#include "simulation/model/substeps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simulation/checks/start_checks.h"
#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"
#include "tests/simulation/model/load_path_scenes.h"

namespace weft::test {
namespace {

Model model_of(const std::string& text, Warnings& warnings) {
    return {parse_scene(text, "test.toml"), warnings};
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

TEST(Substeps, LeftOutAreChosenForBending) {
    Warnings warnings;
    Scene strip = parse_scene(kStrip, "test.toml");
    for (const Method method : {Method::kXpbd, Method::kVbd, Method::kSosd, Method::kJpgd}) {
        strip.solver.method = method;
        const int substeps = Model(strip, warnings).scene.substeps;
        EXPECT_GT(substeps, 55) << name_of(method);
        EXPECT_LT(substeps, 80) << name_of(method);
        EXPECT_EQ(with_substeps(strip).substeps, substeps);
    }
    strip.solver.iterations = 2;
    const int twice = with_substeps(strip).substeps;
    strip.solver.method = Method::kVbd;
    EXPECT_NEAR(twice, std::sqrt(2.0) * with_substeps(strip).substeps, 2.0) << "jpgd, accelerated";
    strip.solver.iterations = 8;
    const int usual = 9;  // of the same strip without bending
    strip.solver.method = Method::kNewton;
    EXPECT_LT(Model(strip, warnings).scene.substeps, usual);
    strip.solver.method = Method::kXpbd;
    strip.cloths[0].bend->stiffness = 1.0e-4;
    EXPECT_EQ(Model(strip, warnings).scene.substeps, usual) << "it hangs down";
    strip.cloths[0].bend.reset();
    EXPECT_EQ(Model(strip, warnings).scene.substeps, usual);
    EXPECT_TRUE(warnings.empty()) << warnings[0];
}

const std::string kBothEnds =
    "pins = { box = [[[-1.0, -1.0, -1.001], [1.0, 1.0, -0.999]], [[-1.0, -1.0, 0.999], [1.0, 1.0, "
    "1.001]]] }\n";

TEST(Substeps, LeftOutAreChosenForSpansByXpbd) {
    Warnings warnings;
    Scene scene = parse_scene(kSheet + kBothEnds, "test.toml");
    scene.cloths[0].stretch.stiffness = 1.0e4;
    const auto chosen = [&] { return Model(scene, warnings).scene.substeps; };
    const int taut = chosen();
    EXPECT_GT(taut, 20);
    EXPECT_LT(taut, 40);
    std::get<GridShape>(scene.cloths[0].shape).resolution = {21, 41};
    EXPECT_NEAR(chosen(), 2 * taut, 0.05 * 2 * taut) << "in proportion to the resolution";
    for (const Method method : {Method::kVbd, Method::kSosd, Method::kJpgd, Method::kNewton}) {
        scene.solver.method = method;
        EXPECT_LT(chosen(), 10) << name_of(method);
    }
    EXPECT_TRUE(warnings.empty()) << warnings[0];
}

TEST(Substeps, ThatAreTooFewForSpansAreWarnedOf) {
    Scene scene = parse_scene(kSheet + kBothEnds, "test.toml");
    const int good = with_substeps(scene).substeps;
    const auto warns = [&](int substeps) {
        scene.substeps = substeps;
        Warnings warnings;
        const Model model(scene, warnings);
        const std::string hint = fmt::format("scene.substeps = {} would do", good);
        return warnings.size() == 1 && warnings[0].find(hint) != std::string::npos;
    };
    EXPECT_FALSE(warns(good));
    EXPECT_FALSE(warns(9 * good / 10));
    EXPECT_TRUE(warns(good / 2));
    scene.solver.method = Method::kVbd;
    EXPECT_FALSE(warns(good / 2));
    scene.solver.method = Method::kXpbd;
    scene.cloths[0].stretch.stiffness = 1.0e9;
    scene.substeps = 0;
    Warnings warnings;
    EXPECT_LE(Model(scene, warnings).scene.substeps, kMostSubsteps);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("'sheet' is stretched between where it is held"), std::string::npos)
        << warnings[0];
}

TEST(Substeps, ThatTheLimitCutsAreWarnedOf) {
    Scene strip = parse_scene(kStrip, "test.toml");
    strip.cloths[0].bend->stiffness = 200.0;
    std::get<GridShape>(strip.cloths[0].shape).resolution = {61, 13};
    Warnings warnings;
    const Model model(strip, warnings);
    EXPECT_EQ(model.scene.substeps, kMostSubsteps);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("'strip' bears its weight by bending"), std::string::npos)
        << warnings[0];
    warnings.clear();
    strip.solver.method = Method::kNewton;
    const Model by_newton(strip, warnings);
    EXPECT_TRUE(warnings.empty());
}

/// The sag that is left falls with the square of the step.
TEST(Substeps, ThatAreFarTooFewForBendingAreWarnedOf) {
    Scene strip = parse_scene(kStrip, "test.toml");
    const int good = with_substeps(strip).substeps;
    const auto warns = [&](int substeps) {
        strip.substeps = substeps;
        Warnings warnings;
        const Model model(strip, warnings);
        const std::string hint = fmt::format("scene.substeps = {} would do", good);
        return warnings.size() == 1 && warnings[0].find(hint) != std::string::npos;
    };
    EXPECT_FALSE(warns(good));
    EXPECT_FALSE(warns(5 * good / 7));
    EXPECT_TRUE(warns(good / 2));
    strip.solver.method = Method::kNewton;
    EXPECT_FALSE(warns(good / 2));
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

/// Where few masses bear many, the mesh asks for more than single precision has.
TEST(Substeps, LeftOutAreNotTooShortForSinglePrecision) {
    Scene scene = parse_scene(kSheet + kPins + kBlock + kTies, "test.toml");
    scene.solver.method = Method::kXpbd;
    scene.solids[0].density = 1e7;
    Warnings warnings;
    const Model model(scene, warnings);
    EXPECT_GT(model.scene.substeps, 100);
    EXPECT_LT(model.scene.substeps, 500);
    Warnings of_start;
    warn_of_start(model, of_start);
    for (const std::string& warning : of_start) {
        EXPECT_EQ(warning.find("are so short that the rounding"), std::string::npos) << warning;
    }
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
