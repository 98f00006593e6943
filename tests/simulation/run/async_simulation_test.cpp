// What a run of asynchronous iterations does besides: plans, losses, resuming, refusals.

#include "runtime/error.h"
#include "simulation/solver/async_iterates.h"
#include "tests/simulation/run/async_runs.h"
#include "tests/simulation/run/failing_device.h"

namespace weft::test {
namespace {

/// As it is planned by itself: by the devices' units, whatever was measured.
TEST(AsyncRuns, TheCutsDoNotDependOnMeasuredTimes) {
    const Scene scene = parse_scene(kEverything, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    Simulation run(scene, cpus(2), options, warnings);
    const int strips = run.model().strips.count();
    for (int frame = 0; frame < kFrames; ++frame) {
        const FrameRecord record = run.advance();
        ASSERT_TRUE(record.graph);
        const auto half = static_cast<std::uint32_t>(strips - strips / 2);
        EXPECT_EQ(record.graph->strips[0], half);
    }
}

TEST(AsyncRuns, ALostDeviceIsLeftOutAndTheRunCanBeReplayed) {
    const Scene scene = parse_scene(kEverything, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    options.calibrate = false;
    Devices devices;
    devices.push_back(make_cpu_device(1, {}));
    devices.push_back(make_failing_device(make_cpu_device(1, {}), {2}));
    Simulation run(scene, std::move(devices), options, warnings);
    const RunDescription description = run.describe();
    SimulationOptions on_one;
    on_one.devices = "cpu/1";
    Replay replay(scene, on_one, description, warnings);
    for (int frame = 0; frame < 4; ++frame) {
        replay.advance(run.advance());
        EXPECT_EQ(replay.simulation().hash(), run.hash());
    }
    EXPECT_EQ(run.losses().size(), 1U);
}

TEST(AsyncRuns, AResumedRunEndsAsOneThatWasNot) {
    const Scene scene = parse_scene(kEverything, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    options.calibrate = false;
    Simulation run(scene, cpus(2), options, warnings);
    run.advance();
    const Checkpoint checkpoint = run.checkpoint();
    run.advance();
    Simulation resumed(scene, cpus(2), options, warnings);
    resumed.resume(checkpoint);
    resumed.advance();
    EXPECT_EQ(resumed.hash(), run.hash());
}

TEST(AsyncRuns, ABadStateIsDiagnosed) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    scene.guard.max_speed = 0.3;
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    options.calibrate = false;
    Simulation run(scene, cpus(2), options, warnings);
    try {
        for (int frame = 0; frame < 10; ++frame) run.advance();
        FAIL() << "nothing was too fast";
    } catch (const RunError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("guard.max_speed"), std::string::npos) << message;
        EXPECT_NE(message.find("substep"), std::string::npos) << message;
    }
}

TEST(AsyncRuns, OnlyXpbdHasTasksByKinds) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    options.async = parse_async_settings("tasks=kinds");
    for (const Method method : {Method::kVbd, Method::kSosd, Method::kJpgd}) {
        scene.solver.method = method;
        EXPECT_THROW(Simulation(scene, cpus(2), options, warnings), UserError);
    }
}

/// What keeps surfaces apart has the last word.
TEST(AsyncRuns, WithContactTheLastIterationIsInStep) {
    const Scene scene = parse_scene(kTouching, "test.toml");
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    for (const char* settings : {"settle=0", "tasks=kinds"}) {
        options.async = parse_async_settings(settings);
        EXPECT_THROW(Simulation(scene, cpus(2), options, warnings), UserError) << settings;
    }
    Model model(scene, warnings);
    AsyncIterates solver(model, make_solver(model), 2, {});
    const int strips = model.strips.count();
    const auto problem = solver.problem_of(Division{{strips / 2, strips - strips / 2}}.partition());
    const int last = scene.solver.iterations - 1;
    int asynchronous = 0;
    for (const auto& task : problem.tasks) {
        EXPECT_TRUE(task.synchronous || task.iteration < last);
        asynchronous += task.synchronous ? 0 : 1;
    }
    EXPECT_GT(asynchronous, 0);
}

TEST(AsyncRuns, NewtonHasNoAsynchronousForm) {
    Scene scene = parse_scene(kSpringsOnly, "test.toml");
    scene.solver.method = Method::kNewton;
    Warnings warnings;
    SimulationOptions options;
    options.plan = PlanKind::kAsync;
    EXPECT_THROW(Simulation(scene, cpus(2), options, warnings), UserError);
}

TEST(AsyncSettingsText, IsReadAsItIsWritten) {
    for (const char* text : {"", "window=3", "wait=0.25,merge=mean", "dropping=on,settle=2",
                             "tasks=kinds", "tasks=kinds,rank=off,order=within", "order=across"}) {
        const AsyncSettings settings = parse_async_settings(text);
        EXPECT_EQ(parse_async_settings(to_text(settings)), settings) << text;
    }
    EXPECT_EQ(parse_async_settings("window=5").window, 5);
    EXPECT_TRUE(parse_async_settings("dropping=on").dropping);
}

TEST(AsyncSettingsText, WhatIsWrongIsRefused) {
    for (const char* text : {"window=0", "window=two", "window", "wait=-1", "wait=nan",
                             "merge=best", "dropping=maybe", "settle=-1", "widnow=2", "=", ",",
                             "tasks=all", "order=none", "rank=no,tasks=kinds", "rank=off"}) {
        EXPECT_THROW(parse_async_settings(text), UserError) << text;
    }
}

}  // namespace
}  // namespace weft::test
