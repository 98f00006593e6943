// The cost model with injected costs: noise, outliers, disturbances, changes.

#include "scheduler/cost_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "scheduler/cost_drift.h"
#include "scheduler/heft.h"
#include "scheduler/plan_choice.h"
#include "scheduler/probing.h"

namespace weft::scheduler {
namespace {

/// Executes tasks of one kind on one device with known cost and 3 % of noise.
class Machine {
public:
    double fixed = 20e-6, per_item = 5e-9, noise = 0.03;

    double seconds(double items) {
        return (fixed + per_item * items) * (1.0 + noise * normal_(random_));
    }
    void run_frame(CostModel& model, double slowdown = 1.0) {
        for (const double items : {1000.0, 4000.0, 10000.0}) {
            for (int i = 0; i < 8; ++i) {
                model.observe(0, 0, items, slowdown * seconds(items));
            }
        }
        model.refit();
    }
    double error(const CostModel& model, double items) const {
        return std::abs(model.predict(0, 0, items) / (fixed + per_item * items) - 1.0);
    }

private:
    std::mt19937 random_{1};
    std::normal_distribution<double> normal_;
};

TEST(CostModel, FindsBothPartsOfTheCost) {
    Machine machine;
    CostModel model(1, 1);
    EXPECT_FALSE(model.known(0, 0));
    EXPECT_EQ(model.predict(0, 0, 1000.0), 0.0);
    for (int frame = 0; frame < 10; ++frame) machine.run_frame(model);
    EXPECT_TRUE(model.known(0, 0));
    for (const double items : {500.0, 4000.0, 20000.0})
        EXPECT_LT(machine.error(model, items), 0.03);
    EXPECT_LT(model.fit(0, 0).spread, 0.05);
}

TEST(CostModel, PredictsACountNeverSeenFromWhatItHasLearnt) {
    CostModel model(1, 1);
    Machine machine;
    // Contacts: more every frame.
    for (int frame = 0; frame < 30; ++frame) {
        const double items = 1000.0 + 500.0 * frame;
        for (int i = 0; i < 8; ++i) model.observe(0, 0, items, machine.seconds(items));
        model.refit();
    }
    EXPECT_LT(machine.error(model, 30000.0), 0.1);
}

TEST(CostModel, NeverLearnsNegativeParts) {
    CostModel model(2, 1);
    for (int frame = 0; frame < 5; ++frame) {
        for (int i = 0; i < 4; ++i) {
            model.observe(0, 0, 1000.0, 2e-3), model.observe(0, 0, 2000.0, 1e-3);  // falling
            model.observe(1, 0, 1000.0, 1e-3), model.observe(1, 0, 2000.0, 9e-3);  // below 0 at 0
        }
        model.refit();
    }
    for (const std::uint32_t kind : {0u, 1u}) {
        EXPECT_GE(model.fit(kind, 0).cost.fixed, 0.0);
        EXPECT_GE(model.fit(kind, 0).cost.per_item, 0.0);
    }
}

TEST(CostModel, DiscardsFirstRunsButUsesThemUntilThereAreOthers) {
    CostModel model(1, 1);
    model.observe(0, 0, 1000.0, 0.5);  // compiles the kernel
    model.refit();
    EXPECT_DOUBLE_EQ(model.predict(0, 0, 1000.0), 0.5);
    model.observe(0, 0, 1000.0, 2e-3);
    model.refit();
    EXPECT_DOUBLE_EQ(model.predict(0, 0, 1000.0), 2e-3);
    model.observe(0, 0, 1000.0, 1e-3);
    model.refit();
    EXPECT_DOUBLE_EQ(model.predict(0, 0, 1000.0), 1e-3);
}

/// Of one frame only: it is a fit as any other.
TEST(CostModel, ARestoredFitKeepsItsShapeWhileItemCountsAreAlike) {
    for (const std::uint32_t frames : {1u, 20u}) {
        CostModel model(1, 1, {.discard_first = 0});
        model.restore(0, 0, {{1e-3, 1e-6}, 0.0, frames});
        for (int i = 0; i < 3; ++i) model.observe(0, 0, 1000.0, 4e-3);  // twice as long
        model.refit();
        EXPECT_DOUBLE_EQ(model.predict(0, 0, 1000.0), 4e-3);
        EXPECT_DOUBLE_EQ(model.predict(0, 0, 3000.0), 8e-3);
    }
}

TEST(CostModel, RejectsOutliersWithinAFrame) {
    Machine machine;
    CostModel model(1, 1);
    for (int frame = 0; frame < 10; ++frame) {
        for (int i = 0; i < 20; ++i) {
            const bool interrupted = i % 5 == 0;
            model.observe(0, 0, 4000.0, machine.seconds(4000.0) * (interrupted ? 30.0 : 1.0));
        }
        model.refit();
    }
    EXPECT_LT(machine.error(model, 4000.0), 0.03);
}

TEST(CostModel, ADisturbanceOfASecondIsNeitherFollowedNorRemembered) {
    // 0.2 s per frame: a second is 5 frames. Everything takes three times as long in it.
    Machine machine;
    CostModel model(1, 1);
    for (int frame = 0; frame < 20; ++frame) machine.run_frame(model);
    for (int frame = 0; frame < 5; ++frame) {
        machine.run_frame(model, 3.0);
        EXPECT_LT(machine.error(model, 4000.0), 0.05) << "in the disturbance, frame " << frame;
    }
    for (int frame = 0; frame < 20; ++frame) {
        machine.run_frame(model);
        EXPECT_LT(machine.error(model, 4000.0), 0.05) << "after it, frame " << frame;
    }
}

TEST(CostModel, FollowsWhatLastsAndForgetsItWhenItEnds) {
    // 1/60 s per frame: a second is 60 frames.
    Machine machine;
    CostModel model(1, 1);
    for (int frame = 0; frame < 20; ++frame) machine.run_frame(model);
    for (int frame = 0; frame < 60; ++frame) machine.run_frame(model, 2.0);
    EXPECT_NEAR(machine.error(model, 4000.0), 1.0, 0.1);
    for (int frame = 0; frame < 12; ++frame) machine.run_frame(model);
    EXPECT_LT(machine.error(model, 4000.0), 0.05);
}

TEST(CostModel, OneProbeCorrectsADeviceThatFellOutOfUseInABadMoment) {
    Machine machine;
    CostModel model(1, 1);
    for (int frame = 0; frame < 20; ++frame) machine.run_frame(model);
    for (int frame = 0; frame < 12; ++frame) machine.run_frame(model, 5.0);
    EXPECT_GT(machine.error(model, 4000.0), 2.0);
    for (int frame = 0; frame < 30; ++frame) model.refit();  // out of use
    EXPECT_EQ(model.frames_unobserved(0, 0), 31u);
    machine.run_frame(model);
    EXPECT_LT(machine.error(model, 4000.0), 0.05);
}

TEST(CostModel, FitsAreSavedAndRestored) {
    Machine machine;
    CostModel before(1, 1), after(1, 1);
    for (int frame = 0; frame < 10; ++frame) machine.run_frame(before);
    after.restore(0, 0, before.fit(0, 0));
    EXPECT_TRUE(after.known(0, 0));
    EXPECT_EQ(after.predict(0, 0, 7000.0), before.predict(0, 0, 7000.0));
    after.observe(0, 0, 4000.0, 1.0);  // the first run is still not believed
    after.refit();
    EXPECT_EQ(after.predict(0, 0, 7000.0), before.predict(0, 0, 7000.0));
    machine.fixed *= 2.0;
    machine.per_item *= 2.0;
    machine.run_frame(after);
    EXPECT_LT(machine.error(after, 4000.0), 0.1);
}

TEST(CostModel, IgnoresTimesThatAreNone) {
    CostModel model(1, 1);
    model.observe(0, 0, 1.0, -1.0);
    model.observe(0, 0, 1.0, std::numeric_limits<double>::quiet_NaN());
    model.observe(0, 0, 1.0, std::numeric_limits<double>::infinity());
    model.refit();
    EXPECT_FALSE(model.known(0, 0));
}

TEST(CostModel, TimesAndItemsOfZeroAreNoTrouble) {
    CostModel model(2, 1);
    for (int frame = 0; frame < 5; ++frame) {
        for (int i = 0; i < 5; ++i) {
            model.observe(0, 0, 0.0, 0.0);
            model.observe(1, 0, 0.0, 1e-3);
            model.observe(1, 0, 100.0, 2e-3);
        }
        model.refit();
    }
    EXPECT_EQ(model.predict(0, 0, 10.0), 0.0);
    EXPECT_EQ(model.fit(0, 0).spread, 0.0);
    EXPECT_NEAR(model.predict(1, 0, 100.0), 2e-3, 1e-9);
    EXPECT_NEAR(model.predict(1, 0, 0.0), 1e-3, 1e-9);
}

// The whole loop: costs are learnt, frames are planned by them, a device is disturbed.
TEST(CostModel, PlansRecoverFromADisturbance) {
    constexpr double kTrue[2] = {10e-9, 10e-9};
    CostModel model(1, 2);
    ProbePolicy probes(2);
    Heft heft;
    Plan plan;
    TaskGraph graph;
    std::mt19937 random(3);
    std::normal_distribution<double> normal(1.0, 0.02);
    const auto frame = [&](double slowdown_of_1) {
        graph.clear(2);
        const double items = 1e6;
        for (int i = 0; i < 10; ++i) {
            graph.add_task(std::vector{model.predict(0, 0, items), model.predict(0, 1, items)});
        }
        graph.seal();
        heft.schedule(graph, plan);
        double load[2] = {};
        for (TaskId t = 0; t < graph.task_count(); ++t) {
            ProcessorId device = plan.placements[t].processor;
            if (t == 0 && probes.due(1, model.predict(0, 1, items))) {
                device = 1;
                probes.paid(1, model.predict(0, 1, items));
            }
            const double slowdown = device == 1 ? slowdown_of_1 : 1.0;
            const double seconds = kTrue[device] * items * normal(random) * slowdown;
            load[device] += seconds;
            model.observe(0, device, items, seconds);
            probes.used(device);
        }
        model.refit();
        const double makespan = std::max(load[0], load[1]);
        probes.end_frame(makespan);
        return makespan;
    };
    const double best = 5 * 1e-2;
    for (int i = 0; i < 30; ++i) frame(1.0);
    EXPECT_LT(frame(1.0), 1.1 * best);
    for (int i = 0; i < 12; ++i) frame(20.0);
    // Now the slow device is left out, and ten tasks on the other one take 2 x best, but for a
    // probe.
    double seconds = 0.0;
    for (int i = 0; i < 30; ++i) seconds += frame(20.0);
    EXPECT_LT(seconds, 1.1 * 30 * 2 * best);
    // A probe comes within its interval as soon as the credit suffices, and then all is well.
    for (int i = 0; i < 400; ++i) frame(1.0);
    EXPECT_LT(frame(1.0), 1.1 * best);
}

TEST(ProbePolicy, BoundsThePrice) {
    ProbePolicy probes(2, {.interval = 10, .price_share = 0.01});
    double spent = 0.0;
    for (int frame = 0; frame < 1000; ++frame) {
        probes.used(0);
        if (probes.due(1, 0.05)) {
            probes.paid(1, 0.05);
            spent += 0.05;
        }
        probes.end_frame(0.1);
        EXPECT_FALSE(probes.due(0, 0.0));
    }
    EXPECT_GT(spent, 0.5);
    EXPECT_LE(spent, 0.01 * 1000 * 0.1 + 0.05) << "more than one is never paid ahead";
}

TEST(PlanChoice, NoiseDoesNotFlipPlans) {
    PlanChoice choice(2);
    std::mt19937 random(1);
    std::normal_distribution<double> normal(1.0, 0.02);
    int changes = 0;
    std::uint32_t last = choice.choose(std::vector{1.0, 1.001});
    for (int frame = 0; frame < 200; ++frame) {
        const std::uint32_t now = choice.choose(std::vector{normal(random), normal(random)});
        changes += now != last;
        last = now;
    }
    EXPECT_LE(changes, 2);
}

TEST(PlanChoice, TiesGoToTheFirst) {
    PlanChoice choice(3);
    EXPECT_EQ(choice.choose(std::vector{2.0, 1.0, 1.0}), 1u);
}

TEST(PlanChoice, IgnoresTimesThatAreNone) {
    PlanChoice choice(2);
    for (int frame = 0; frame < 20; ++frame) {
        choice.measured(0, 0.0, 1.0);
        choice.measured(0, 1.0, 0.0);
        choice.measured(1, std::numeric_limits<double>::quiet_NaN(), 1.0);
    }
    EXPECT_EQ(choice.correction(0), 1.0);
    EXPECT_EQ(choice.correction(1), 1.0);
}

TEST(PlanChoice, ChangesForALastingGain) {
    PlanChoice choice(2, {.patience = 3});
    EXPECT_EQ(choice.choose(std::vector{1.0, 1.2}), 0u);
    EXPECT_EQ(choice.choose(std::vector{1.0, 0.8}), 0u);
    EXPECT_EQ(choice.choose(std::vector{1.0, 0.8}), 0u);
    EXPECT_EQ(choice.choose(std::vector{1.0, 0.8}), 1u);
}

TEST(PlanChoice, LeavesAnImpossibleAlternativeAtOnce) {
    PlanChoice choice(2);
    EXPECT_EQ(choice.choose(std::vector{1.0, 2.0}), 0u);
    const double lost = std::numeric_limits<double>::infinity();
    EXPECT_EQ(choice.choose(std::vector{lost, 2.0}), 1u);
}

TEST(PlanChoice, SwitchesIfMeasurementsSayOtherwise) {
    PlanChoice choice(2);
    std::uint32_t now = 0;
    for (int frame = 0; frame < 30; ++frame) {
        now = choice.choose(std::vector{1.0, 1.2});
        choice.measured(now, now == 0 ? 1.0 : 1.2, now == 0 ? 1.6 : 1.2);
    }
    EXPECT_EQ(now, 1u);
    EXPECT_NEAR(choice.correction(1), 1.0, 0.01);
}

TEST(PlanChoice, OneDisturbedFrameChangesNothing) {
    PlanChoice choice(2);
    EXPECT_EQ(choice.choose(std::vector{1.0, 1.2}), 0u);
    choice.measured(0, 1.0, 50.0);
    for (int frame = 0; frame < 10; ++frame) {
        EXPECT_EQ(choice.choose(std::vector{1.0, 1.2}), 0u);
        choice.measured(0, 1.0, 1.0);
    }
}

/// Two devices, of which the second one takes twice as long; what is to be done takes so many times
/// as long as at the beginning.
void run_frame(CostModel& model, CostDrift& drift, double work, bool both) {
    for (const double items : {1000.0, 4000.0, 10000.0}) {
        for (int i = 0; i < 8; ++i) {
            model.observe(0, 0, items, work * 1e-8 * items);
            if (both) model.observe(0, 1, items, work * 2e-8 * items);
        }
    }
    model.refit();
    drift.note(model);
}

TEST(CostDrift, IsWhatDevicesInUseTellOfThoseThatAreNot) {
    CostModel model(1, 2);
    CostDrift drift(1, 2);
    const auto cost = [&](std::uint32_t device) { return drift.predict(model, 0, device, 4000.0); };
    const auto expect_none = [&](std::uint32_t device) {
        EXPECT_EQ(cost(device), model.predict(0, device, 4000.0)) << device;
    };
    for (int frame = 0; frame < 4; ++frame) run_frame(model, drift, 1.0, true);
    expect_none(0);
    expect_none(1);
    for (int frame = 0; frame < 30; ++frame) run_frame(model, drift, 5.0, false);
    expect_none(0);
    EXPECT_NEAR(cost(1), 5.0 * 2e-8 * 4000.0, 1e-9);
    run_frame(model, drift, 5.0, true);
    expect_none(1);  // it has been seen itself
}

/// One has only seen a few items, and takes all of it for fixed.
TEST(CostDrift, CountsWhatItemsTellOnce) {
    CostModel model(1, 2);
    CostDrift drift(1, 2);
    model.restore(0, 0, {{100e-6, 0.0}, 0.0, 5});
    model.restore(0, 1, {{0.0, 200e-9}, 0.0, 5});
    const auto run = [&](double items, double seconds, bool both) {
        for (int i = 0; i < 8; ++i) {
            model.observe(0, 0, items, seconds);
            if (both) model.observe(0, 1, items, 2.0 * seconds);
        }
        model.refit();
        drift.note(model);
    };
    for (int frame = 0; frame < 4; ++frame) run(1000.0, 100e-6, true);
    for (int frame = 0; frame < 30; ++frame) run(5000.0, 500e-6, false);
    EXPECT_NEAR(drift.predict(model, 0, 1, 5000.0), 1000e-6, 1e-6);
}

TEST(CostDrift, IsNoneWhereNothingIsKnown) {
    CostModel model(1, 2);
    CostDrift drift(1, 2);
    EXPECT_EQ(drift.predict(model, 0, 1, 100.0), 0.0);
    for (int frame = 0; frame < 4; ++frame) run_frame(model, drift, 3.0, false);
    EXPECT_EQ(drift.predict(model, 0, 1, 100.0), 0.0);
}

}  // namespace
}  // namespace weft::scheduler
