// Asynchronous iterations: results that depend on the cuts and the settings, and on nothing else.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/cpu_device.h"
#include "scheduler/exchange_map.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/solver/async_iterates.h"
#include "tests/simulation/run/failing_device.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

constexpr int kFrames = 3;

using Devices = std::vector<std::unique_ptr<Device>>;

Devices cpus(int count) {
    Devices devices;
    for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}));
    return devices;
}

struct TestCase {
    Method method;
    const std::string* scene;
    int iterations = 5;
};

std::string name_of_case(const testing::TestParamInfo<TestCase>& info) {
    std::string name(name_of(info.param.method));
    const bool touches = info.param.scene == &kTouching;
    name += info.param.scene == &kSolids ? "Solids" : touches ? "Touching" : "Everything";
    return name + std::to_string(info.param.iterations);
}

class Async : public testing::TestWithParam<TestCase> {
protected:
    Async() : scene_(parse_scene(*GetParam().scene, "test.toml")) {
        scene_.solver.method = GetParam().method;
        scene_.solver.iterations = GetParam().iterations;
        strips_ = Model(scene_, warnings_).strips.count();
    }
    std::unique_ptr<Simulation> simulation(Devices devices, const Division& division,
                                           const std::string& settings) {
        SimulationOptions options;
        options.division = division;
        options.plan = PlanKind::kAsync;
        options.async = parse_async_settings(allowed(settings));
        options.calibrate = false;
        return std::make_unique<Simulation>(scene_, std::move(devices), options, warnings_);
    }
    /// With contact at least the last iteration is in step.
    std::string allowed(std::string settings) const {
        const std::size_t at = settings.find("settle=0");
        if (scene_.contact && at != std::string::npos) settings.erase(at > 0 ? at - 1 : 0);
        return settings;
    }
    static std::string hash_of(Simulation& run) {
        for (int frame = 0; frame < kFrames; ++frame) run.advance();
        return run.hash();
    }
    std::string synchronous_hash() {
        SimulationOptions options;
        options.division = Division{{strips_}};
        options.calibrate = false;
        Simulation run(scene_, cpus(1), options, warnings_);
        return hash_of(run);
    }
    Division in_two() const { return {{strips_ / 2, strips_ - strips_ / 2}}; }
    Division in_three() const { return {{1, strips_ - 2, 1}}; }

    /// Task by task on one device, by the same map.
    void expect_same_on_one_device(Simulation& run) {
        const RunDescription description = run.describe();
        SimulationOptions options;
        options.devices = "cpu/1";
        Replay twin(scene_, options, description, warnings_);
        for (int frame = 0; frame < kFrames; ++frame) {
            twin.advance(run.advance());
            EXPECT_EQ(twin.simulation().hash(), run.hash()) << frame;
        }
    }

    Scene scene_;
    Warnings warnings_;
    int strips_ = 0;
};

TEST_P(Async, AWindowOfOneIsTheSynchronousSolver) {
    const std::string expected = synchronous_hash();
    EXPECT_EQ(hash_of(*simulation(cpus(2), in_two(), "window=1")), expected);
    EXPECT_EQ(hash_of(*simulation(cpus(3), in_three(), "window=1")), expected);
}

TEST_P(Async, TheSerialisedTwinHasTheSameBits) {
    expect_same_on_one_device(*simulation(cpus(2), in_two(), ""));
    expect_same_on_one_device(*simulation(cpus(3), in_three(), ""));
}

TEST_P(Async, TheTwinHasThemWithEverySetting) {
    for (const char* settings : {"dropping=on", "window=3,merge=mean,settle=0", "wait=0,merge=sum",
                                 "merge=position,dropping=on,settle=2", "order=within,settle=0",
                                 "order=across,window=3", "order=free,settle=0"}) {
        SCOPED_TRACE(settings);
        expect_same_on_one_device(*simulation(cpus(2), in_two(), settings));
    }
}

TEST_P(Async, RunsAgainAndAgainAreTheSame) {
    const std::string first = hash_of(*simulation(cpus(2), in_two(), "settle=0"));
    EXPECT_NE(first, synchronous_hash());
    for (int again = 0; again < 3; ++again) {
        EXPECT_EQ(hash_of(*simulation(cpus(2), in_two(), "settle=0")), first);
    }
}

/// As where devices of another team stand beside these, or one was lost.
TEST_P(Async, IteratesThatNobodyHasChangeNothing) {
    const std::string expected = hash_of(*simulation(cpus(2), in_two(), "window=3,settle=0"));
    Division among_three = in_two();
    among_three.strips.push_back(0);
    EXPECT_EQ(hash_of(*simulation(cpus(3), among_three, "window=3,settle=0")), expected);
}

/// Asynchronous tasks read and write no iterate but their part's; what they wait for of others are
/// tasks of the exchange.
TEST_P(Async, TasksKeepToTheirOwn) {
    Model model(scene_, warnings_);
    AsyncIterates solver(model, make_solver(model), 2, {});
    const Step step = solver.make_step(in_two().partition());
    const auto kinds = static_cast<int>(make_solver(model)->kinds().size());
    const auto is_exchange = [&](int task) {
        return step.tasks()[static_cast<std::size_t>(task)].body->kind >= kinds;
    };
    std::set<int> asynchronous;
    for (const int kind : make_solver(model)->asynchrony().kinds) asynchronous.insert(kind);
    int waits = 0;
    for (const Dependency& d : step.dependencies()) {
        const Task& to = step.tasks()[static_cast<std::size_t>(d.to)];
        const Task& from = step.tasks()[static_cast<std::size_t>(d.from)];
        const int settled = scene_.solver.iterations - 1;
        if (from.region == to.region || to.iteration >= settled) continue;
        if (asynchronous.contains(to.body->kind) && asynchronous.contains(from.body->kind)) {
            ADD_FAILURE() << from.body->name << " -> " << to.body->name;
        }
        waits += is_exchange(d.from) || is_exchange(d.to) ? 1 : 0;
    }
    EXPECT_GT(waits, 0);
}

TEST_P(Async, ItsMapsHold) {
    Model model(scene_, warnings_);
    for (const char* settings :
         {"", "dropping=on", "window=3,settle=0", "window=4,settle=0", "window=4,wait=0.2",
          "order=within,wait=0.1,settle=0", "order=across,window=3,settle=0"}) {
        AsyncIterates solver(model, make_solver(model), 3, parse_async_settings(allowed(settings)));
        for (const Division& division : {in_two(), in_three()}) {
            const auto problem = solver.problem_of(division.partition());
            const auto map = scheduler::make_exchange_map(problem);
            EXPECT_EQ(scheduler::find_fault(problem, map), "") << settings;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Solvers, Async,
    testing::Values(TestCase{Method::kXpbd, &kEverything}, TestCase{Method::kXpbd, &kSolids},
                    TestCase{Method::kVbd, &kEverything}, TestCase{Method::kVbd, &kSolids},
                    TestCase{Method::kSosd, &kEverything}, TestCase{Method::kSosd, &kSolids},
                    TestCase{Method::kJpgd, &kEverything}, TestCase{Method::kJpgd, &kSolids, 10},
                    TestCase{Method::kXpbd, &kTouching}, TestCase{Method::kVbd, &kTouching},
                    TestCase{Method::kSosd, &kTouching}, TestCase{Method::kJpgd, &kTouching, 10}),
    name_of_case);

/// JPGD's checks of energy may take back what was done. Of the eight iterations from one to the
/// next the first two stay in step, all others (but those that settle) do not.
TEST(AsyncJpgd, TheFirstTwoIterationsBehindACheckStayInStep) {
    Scene scene = parse_scene(kSolids, "test.toml");
    scene.solver.method = Method::kJpgd;
    scene.solver.iterations = 21;
    Warnings warnings;
    Model model(scene, warnings);
    const int strips = model.strips.count();
    AsyncIterates solver(model, make_solver(model), 2, parse_async_settings("settle=2"));
    const Division halves{{strips / 2, strips - strips / 2}};
    const auto base = make_solver(model);
    const Step step = base->make_step(halves.partition());
    const auto problem = solver.problem_of(halves.partition());
    ASSERT_EQ(problem.tasks.size(), step.tasks().size());
    std::set<int> in_step;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const std::string& kind = step.tasks()[t].body->name;
        if (kind != "step" && kind != "refresh") {
            EXPECT_TRUE(problem.tasks[t].synchronous) << kind;
        } else if (problem.tasks[t].synchronous) {
            in_step.insert(problem.tasks[t].iteration);
        }
    }
    EXPECT_EQ(in_step, (std::set{0, 1, 8, 9, 16, 17, 19, 20}));
}

/// Which iteration's work of each device a place has of a cell.
using Seen = std::map<std::pair<int, int>, std::map<int, int>>;

/// What a check took back must not come in again by what another device still has of it.
TEST(AsyncJpgd, NobodyLooksBehindACheck) {
    Scene scene = parse_scene(kSolids, "test.toml");
    scene.solver.method = Method::kJpgd;
    scene.solver.iterations = 24;
    Warnings warnings;
    Model model(scene, warnings);
    const int strips = model.strips.count();
    for (const char* settings : {"settle=0", "window=4,settle=0"}) {
        AsyncIterates solver(model, make_solver(model), 2, parse_async_settings(settings));
        const auto problem =
            solver.problem_of(Division{{strips / 2, strips - strips / 2}}.partition());
        Seen seen;
        int looks = 0;
        for (const auto& step : scheduler::make_exchange_map(problem).steps) {
            using Kind = scheduler::ExchangeStep::Kind;
            for (int c = step.cells.begin; step.kind != Kind::kTask && c < step.cells.end; ++c) {
                std::map<int, int> merged = seen[{step.from, c}];
                if (step.kind == Kind::kMerge) {
                    for (const auto& [device, iteration] : seen[{step.to, c}])
                        merged[device] = std::max(merged[device], iteration);
                }
                seen[{step.to, c}] = merged;
            }
            if (step.kind != Kind::kTask) continue;
            const auto& task = problem.tasks[static_cast<std::size_t>(step.task)];
            for (const auto& range : task.reads) {
                for (int c = range.begin; c < range.end && !task.synchronous; ++c) {
                    for (const auto& [device, iteration] : seen[{task.device, c}]) {
                        EXPECT_GE(iteration, task.iteration / 8 * 8) << settings << ' ' << c;
                        looks += device != task.device ? 1 : 0;
                    }
                }
            }
            for (const auto& range : task.writes) {
                for (int c = range.begin; c < range.end; ++c)
                    seen[{task.device, c}][task.device] = task.iteration;
            }
        }
        EXPECT_GT(looks, 0);
    }
}

/// As the paper cuts an iteration: kinds of tasks instead of strips.
class AsyncKinds : public Async {
protected:
    static constexpr const char* kSettings[] = {
        "tasks=kinds",
        "tasks=kinds,rank=off,settle=0",
        "tasks=kinds,wait=0.2,dropping=on,settle=0",
        "tasks=kinds,order=free,merge=mean,settle=0",
        "tasks=kinds,order=within,wait=0.1,settle=0",
        "tasks=kinds,order=across,wait=0.1,window=3,merge=position"};
};

TEST_P(AsyncKinds, TasksByKindsAloneChangeNoBits) {
    SimulationOptions options;
    options.division = Division{{strips_ / 2, strips_ - strips_ / 2}};
    options.calibrate = false;
    options.make_solver = make_solver_by_kinds;
    Simulation run(scene_, cpus(2), options, warnings_);
    EXPECT_EQ(hash_of(run), synchronous_hash());
}

TEST_P(AsyncKinds, AWindowOfOneIsTheSynchronousSolver) {
    const std::string expected = synchronous_hash();
    for (const char* settings :
         {"tasks=kinds,window=1,wait=0.1", "tasks=kinds,window=1,wait=0.1,rank=off,order=within"}) {
        EXPECT_EQ(hash_of(*simulation(cpus(2), in_two(), settings)), expected) << settings;
    }
}

TEST_P(AsyncKinds, TheSerialisedTwinHasTheSameBits) {
    for (const char* settings : kSettings) {
        SCOPED_TRACE(settings);
        expect_same_on_one_device(*simulation(cpus(2), in_two(), settings));
    }
}

TEST_P(AsyncKinds, BothDevicesTakePartAndTheMapsHold) {
    Model model(scene_, warnings_);
    for (const char* settings : kSettings) {
        AsyncIterates solver(model, make_solver_by_kinds(model), 2, parse_async_settings(settings));
        const auto problem = solver.problem_of(in_two().partition());
        std::set<int> devices;
        for (const auto& task : problem.tasks) devices.insert(task.device);
        EXPECT_EQ(devices.size(), 2U) << settings;
        EXPECT_EQ(scheduler::find_fault(problem, scheduler::make_exchange_map(problem)), "")
            << settings;
    }
}

/// Who has more strips is faster, and gets more to do.
TEST_P(AsyncKinds, TheFasterDeviceDoesMore) {
    Model model(scene_, warnings_);
    AsyncIterates solver(model, make_solver_by_kinds(model), 2,
                         parse_async_settings("tasks=kinds,wait=0.1,settle=0"));
    const auto problem = solver.problem_of(Division{{1, strips_ - 1}}.partition());
    std::array<std::size_t, 2> done{};
    for (const auto& task : problem.tasks) ++done[static_cast<std::size_t>(task.device)];
    EXPECT_GT(done[1], 2 * done[0]);
}

TEST_P(AsyncKinds, MoreThanTwoDevicesAreRefused) {
    EXPECT_THROW(simulation(cpus(3), in_three(), "tasks=kinds")->advance(), UserError);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AsyncKinds,
                         testing::Values(TestCase{Method::kXpbd, &kEverything},
                                         TestCase{Method::kXpbd, &kSolids}),
                         name_of_case);

/// Fewer cases: each builds its kernels.
class AsyncBesideOpenCl : public Async {};

TEST_P(AsyncBesideOpenCl, InMemoryOfItsOwn) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    Devices devices = cpus(1);
    DeviceOptions options;
    options.memory = MemoryModel::kDiscrete;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
    expect_same_on_one_device(*simulation(std::move(devices), in_two(), ""));
}

/// Small enough for oclgrind, which cannot run packs of 8: copies, merges and slots in one substep.
TEST_P(AsyncBesideOpenCl, OneSubstepOfOneLane) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    scene_.substeps = 1;
    const auto expected = simulation(cpus(2), in_two(), "settle=0");
    expected->advance();
    Devices devices = cpus(1);
    DeviceOptions options;
    options.opencl_lanes = 1;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
    const auto run = simulation(std::move(devices), in_two(), "settle=0");
    run->advance();
    EXPECT_EQ(run->hash(), expected->hash());
}

/// A core and one or two parts of an OpenCL device, more than there may be cores: twenty times the
/// same, and the same as on cores alone.
TEST_P(AsyncBesideOpenCl, AgainAndAgain) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    if (opencl_devices()[0].units < 2) GTEST_SKIP() << "it cannot be divided";
    for (const std::vector<int>& parts : {std::vector{1}, std::vector{1, 1}}) {
        const Division division = parts.size() == 1 ? in_two() : in_three();
        Devices devices = cpus(1);
        for (auto& device : open_opencl_device(0, parts, {})) devices.push_back(std::move(device));
        const auto run = simulation(std::move(devices), division, "");
        const Checkpoint start = run->checkpoint();
        const std::string first = hash_of(*run);
        for (int again = 0; again < 20; ++again) {
            run->resume(start);
            EXPECT_EQ(hash_of(*run), first) << again;
        }
        EXPECT_EQ(hash_of(*simulation(cpus(1 + static_cast<int>(parts.size())), division, "")),
                  first);
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, AsyncBesideOpenCl,
                         testing::Values(TestCase{Method::kXpbd, &kEverything},
                                         TestCase{Method::kVbd, &kEverything},
                                         TestCase{Method::kXpbd, &kSolids},
                                         TestCase{Method::kXpbd, &kTouching},
                                         TestCase{Method::kVbd, &kTouching}),
                         name_of_case);

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
    devices.push_back(make_failing_device(make_cpu_device(1, {}), 2));
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
