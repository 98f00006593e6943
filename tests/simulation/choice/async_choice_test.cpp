// Whether an asynchronous plan pays: what it loses, what it would take on a machine, and what
// `auto` makes of both.

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/tbb/cpu_device.h"
#include "simulation/choice/async_loss.h"
#include "simulation/choice/async_offer.h"
#include "simulation/choice/machine_forecast.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/solver/async_iterates.h"
#include "tests/simulation/run/test_scenes.h"
#include "tests/simulation/run/touching_sheets.h"

namespace weft::test {
namespace {

/// Costs per item and waits [s] of a machine; every kind of task alike.
TimingModel machine(std::size_t kinds, const std::vector<double>& per_item, double wait) {
    TimingModel timing(kinds, per_item.size());
    for (std::uint32_t d = 0; d < per_item.size(); ++d) {
        for (std::uint32_t kind = 0; kind < kinds; ++kind) {
            timing.costs().restore(kind, d, {{1e-6, per_item[d]}, 0.0, 1});
        }
        for (std::uint32_t to = 0; to < per_item.size(); ++to) {
            if (to != d) timing.set_latency(static_cast<int>(d), static_cast<int>(to), wait);
        }
    }
    return timing;
}

class OnMachines : public testing::TestWithParam<Method> {
protected:
    OnMachines() : scene_(scene()), model_(scene_, warnings_), solver_(make_solver(model_)) {}

    static Scene scene() {
        Scene scene = parse_scene(kSpringsOnly, "test.toml");
        scene.solver.method = GetParam();
        scene.solver.iterations = 8;
        return scene;
    }
    std::unique_ptr<AsyncIterates> async(int devices, const char* settings = "") {
        return std::make_unique<AsyncIterates>(model_, make_solver(model_), devices,
                                               parse_async_settings(settings));
    }
    Forecast forecast(const std::vector<double>& per_item, double wait) {
        const auto form = async(static_cast<int>(per_item.size()));
        Forecaster forecaster(*solver_, {form.get()}, model_.strips.count(),
                              static_cast<int>(per_item.size()));
        return forecaster.forecast(machine(solver_->kinds().size(), per_item, wait));
    }

    Warnings warnings_;
    Scene scene_;
    Model model_;
    std::unique_ptr<Solver> solver_;
};

TEST_P(OnMachines, WithoutWaitsTwoThatAreAlikeTakeHalf) {
    const Forecast f = forecast({1e-7, 1e-7}, 1e-9);
    EXPECT_LT(f.exact, 0.75 * f.single);
    EXPECT_GT(f.exact, 0.5 * f.single);
    ASSERT_EQ(f.async.size(), 1U);
    EXPECT_GE(f.async[0], 0.5 * f.single);
}

TEST_P(OnMachines, LongWaitsLeaveExactPlansBehind) {
    const Forecast near = forecast({1e-7, 1e-7}, 1e-6);
    const Forecast far = forecast({1e-7, 1e-7}, 1e-3);
    EXPECT_DOUBLE_EQ(near.single, far.single);
    EXPECT_GT(far.exact, far.single);
    EXPECT_GT(far.exact, 2.0 * near.exact);
}

/// Half an iteration of waiting: an exact plan stands still for a part of it, an asynchronous one
/// does not.
TEST_P(OnMachines, AsynchronousPlansHideLongerWaitsThanExactOnes) {
    const Forecast none = forecast({1e-6, 1e-6}, 1e-9);
    const double iteration = none.exact / 8;
    const Forecast some = forecast({1e-6, 1e-6}, 0.9 * iteration);
    EXPECT_LT(some.async[0] / none.async[0], some.exact / none.exact);
}

TEST_P(OnMachines, AFastDeviceIsUsedAlone) {
    const Forecast f = forecast({1e-6, 1e-8}, 1e-4);
    EXPECT_LT(f.single, f.exact);
}

INSTANTIATE_TEST_SUITE_P(Solvers, OnMachines,
                         testing::Values(Method::kXpbd, Method::kVbd, Method::kJpgd),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

/// From the state after so many frames.
AsyncLoss loss_of(const Scene& scene, int frames = 4) {
    Warnings warnings;
    SimulationOptions options;
    options.devices = "cpu/1";
    options.calibrate = false;
    Simulation run(scene, options, warnings);
    while (run.frame() < frames) run.advance();
    return {scene, frames, run.positions(), run.velocities()};
}

Scene hanging(Method method, int iterations) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    scene.solver.method = method;
    scene.solver.iterations = iterations;
    return scene;
}

TEST(AsyncLosses, AWindowOfOneLosesNothing) {
    for (const Method method : {Method::kXpbd, Method::kVbd}) {
        AsyncLoss loss = loss_of(hanging(method, 8));
        EXPECT_EQ(loss.factor(parse_async_settings("window=1"), 2), 1.0);
    }
}

/// By xpbd more iterations may make a larger error, and both ways then get by with fewer.
TEST(AsyncLosses, BothWaysNeedAsManyAsTheirErrorsDo) {
    for (const int iterations : {4, 6}) {
        Scene scene = read_scene(std::string(WEFT_SCENES) + "/tablecloth.toml");
        scene.substeps = 10;
        scene.solver.iterations = iterations;
        AsyncLoss loss = loss_of(scene, 15);
        EXPECT_EQ(loss.factor(parse_async_settings("window=1"), 2), 1.0) << iterations;
    }
}

TEST(AsyncLosses, OlderNewsCostMore) {
    AsyncLoss loss = loss_of(hanging(Method::kVbd, 12));
    const auto one = loss.factor(parse_async_settings("window=2"), 2);
    const auto three = loss.factor(parse_async_settings("window=4"), 2);
    ASSERT_TRUE(one && three);
    EXPECT_GE(*one, 1.0);
    EXPECT_LT(*one, 1.5);
    EXPECT_GE(*three, *one);
}

/// Two sheets that press each other: contacts are in what is counted as error, with what presses
/// them at the end; planes, which hold back both ways alike, are not.
Scene touching(Method method, int iterations) {
    Scene scene = parse_scene(
        "[scene]\nframes = 8\ndt = 0.01\nsubsteps = 2\n[contact]\n"
        "thickness = 0.02\n" +
            kTouchingSheets,
        "test.toml");
    scene.solver.method = method;
    scene.solver.iterations = iterations;
    return scene;
}

TEST(AsyncLosses, ContactsAreCounted) {
    for (const Method method : {Method::kXpbd, Method::kVbd, Method::kJpgd}) {
        AsyncLoss loss = loss_of(touching(method, 12));
        EXPECT_EQ(loss.factor(parse_async_settings("window=1"), 2), 1.0) << name_of(method);
        const auto more = loss.factor(parse_async_settings("window=3"), 2);
        ASSERT_TRUE(more) << name_of(method);
        EXPECT_GT(*more, 1.0) << name_of(method);
        EXPECT_LT(*more, 2.0) << name_of(method);
    }
}

TEST(AsyncLosses, FreeFallTellsNothing) {
    Scene scene = hanging(Method::kVbd, 8);
    for (auto& cloth : scene.cloths) cloth.pins.clear();
    EXPECT_FALSE(loss_of(scene).factor({}, 2));
}

/// As a run asks it, about a machine that is made up.
class Offers : public testing::Test {
protected:
    Offers()
        : scene_(hanging(Method::kVbd, 8)),
          model_(scene_, warnings_),
          solver_(make_solver(model_)) {}

    /// Of one iteration by both devices together [s].
    double iteration() {
        const auto form =
            std::make_unique<AsyncIterates>(model_, make_solver(model_), 2, AsyncSettings{});
        Forecaster forecaster(*solver_, {form.get()}, model_.strips.count(), 2);
        const auto f = forecaster.forecast(machine(solver_->kinds().size(), {1e-6, 1e-6}, 1e-9));
        return f.exact / scene_.solver.iterations;
    }
    AsyncOffer offer(double wait) {
        const TimingModel timing = machine(solver_->kinds().size(), {1e-6, 1e-6}, wait);
        std::vector<std::unique_ptr<Device>> owned;
        std::vector<Device*> devices;
        for (int d = 0; d < 2; ++d) {
            devices.push_back(owned.emplace_back(make_cpu_device(1, {})).get());
        }
        FramePlanner planner(*solver_, model_.strips.count(), devices, PlanKind::kAuto);
        planner.timing().inherit(timing, {0, 1});
        planner.balance_mixture();
        const int strips = model_.strips.count();
        return AsyncOffer({model_,
                           *solver_,
                           planner.next(),
                           planner.timing(),
                           Division{{strips / 2, strips - strips / 2}},
                           {}});
    }

    Warnings warnings_;
    Scene scene_;
    Model model_;
    std::unique_ptr<Solver> solver_;
};

TEST_F(Offers, WithoutWaitsThereIsNothingToGain) {
    const AsyncOffer made = offer(1e-7);
    EXPECT_FALSE(made.is_better()) << made.why();
    EXPECT_TRUE(made.why().starts_with("not async")) << made.why();
}

TEST_F(Offers, WaitsOfAWholeIterationAreWorthIt) {
    const AsyncOffer made = offer(0.9 * iteration());
    EXPECT_TRUE(made.is_better()) << made.why();
    EXPECT_TRUE(made.why().starts_with("async: ")) << made.why();
    EXPECT_NE(made.why().find("times the iterations"), std::string::npos) << made.why();
}

TEST_F(Offers, WaitsOfManyIterationsLeaveItToOneDevice) {
    const AsyncOffer made = offer(1.0);
    EXPECT_FALSE(made.is_better()) << made.why();
    EXPECT_NE(made.why().find("single"), std::string::npos) << made.why();
}

}  // namespace
}  // namespace weft::test
