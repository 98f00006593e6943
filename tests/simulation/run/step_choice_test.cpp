// Which steps a run takes next, and how much it tells.

#include "simulation/run/step_choice.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulation/checks/watch.h"
#include "simulation/run/troubles.h"

namespace weft::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scene with_steps(Steps steps, double tolerance = 0.0) {
    Scene scene;
    scene.substeps = steps.substeps;
    scene.solver.iterations = steps.iterations;
    scene.solver.tolerance = tolerance;
    return scene;
}

TEST(StepChoice, HalvesStepsFourTimes) {
    const StepChoice choice(with_steps({3, 8}));
    Steps steps{3, 8};
    for (const int substeps : {6, 12, 24, 48}) {
        const auto halved = choice.halved(with_steps(steps));
        ASSERT_TRUE(halved);
        EXPECT_EQ(halved->substeps, substeps);
        EXPECT_EQ(halved->iterations, 8);
        steps = *halved;
    }
    EXPECT_FALSE(choice.halved(with_steps(steps)));
}

TEST(StepChoice, MissesNoToleranceThatNobodyAskedFor) {
    EXPECT_FALSE(StepChoice::misses_tolerance(with_steps({1, 8}), 1.0));
    EXPECT_FALSE(StepChoice::misses_tolerance(with_steps({1, 8}, 0.1), 0.1));
    EXPECT_TRUE(StepChoice::misses_tolerance(with_steps({1, 8}, 0.1), 0.11));
    EXPECT_TRUE(StepChoice::misses_tolerance(with_steps({1, 8}, 0.1), kNaN));
}

TEST(StepChoice, TakesMoreIterationsUpToThoseOfTheStart) {
    StepChoice choice(with_steps({2, 20}, 0.1));
    const auto more = choice.with_more_iterations(with_steps({2, 8}, 0.1));
    ASSERT_TRUE(more);
    EXPECT_EQ(more->iterations, 16);
    EXPECT_EQ(more->substeps, 2);
    EXPECT_EQ(choice.with_more_iterations(with_steps({2, 16}, 0.1))->iterations, 20);
    EXPECT_FALSE(choice.with_more_iterations(with_steps({2, 20}, 0.1)));
    EXPECT_EQ(choice.failed_iterations(), 16);
}

TEST(StepChoice, TakesFewerIterationsWhereTheseDidNotFail) {
    StepChoice choice(with_steps({2, 20}, 0.1));
    const Scene scene = with_steps({2, 20}, 0.1);
    EXPECT_EQ(choice.with_fewer_iterations(scene, 0.01)->iterations, 10);
    EXPECT_EQ(choice.with_fewer_iterations(with_steps({2, 3}, 0.1), 0.01)->iterations, 2);
    EXPECT_FALSE(choice.with_fewer_iterations(scene, 0.02));
    EXPECT_FALSE(choice.with_fewer_iterations(scene, kNaN)) << "not estimated";
    EXPECT_FALSE(choice.with_fewer_iterations(with_steps({2, 1}, 0.1), 0.0));
    EXPECT_FALSE(choice.with_fewer_iterations(with_steps({2, 20}), 0.0)) << "no tolerance";
    choice.resume(10);
    EXPECT_FALSE(choice.with_fewer_iterations(scene, 0.01));
}

TEST(Troubles, TellsTenOfThemAndWhatIsToldOnce) {
    Troubles troubles;
    const Alarm doubt{Alarm::Kind::kDoubt, "odd", {}};
    const Alarm explosion{Alarm::Kind::kExplosion, "too fast", {}};
    troubles.tell(3, explosion, "done again");
    for (int frame = 4; frame < 20; ++frame) troubles.tell(frame, doubt, "look at it");
    troubles.tell_once(20, "by the way");
    ASSERT_EQ(troubles.list().size(), 11U);
    EXPECT_EQ(troubles.list()[0].what, "too fast; done again");
    EXPECT_TRUE(troubles.list()[0].is_explosion);
    EXPECT_FALSE(troubles.list()[1].is_explosion);
    EXPECT_EQ(troubles.list()[9].what, "odd; look at it; what comes after this is not told");
    EXPECT_EQ(troubles.list()[10].what, "by the way");
}

}  // namespace
}  // namespace weft::test
