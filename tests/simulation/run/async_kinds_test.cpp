// Devices that share kinds of tasks, not strips.

#include <array>
#include <set>

#include "runtime/error.h"
#include "scheduler/exchange_map.h"
#include "simulation/solver/async_iterates.h"
#include "tests/simulation/run/async_runs.h"

namespace weft::test {
namespace {

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
                         testing::Values(AsyncCase{Method::kXpbd, &kEverything},
                                         AsyncCase{Method::kXpbd, &kSolids}),
                         name_of_case);

}  // namespace
}  // namespace weft::test
