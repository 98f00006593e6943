// Asynchronous iterations: results that depend on the cuts and the settings, and on nothing else.

#include <algorithm>
#include <map>
#include <set>

#include "scheduler/exchange_map.h"
#include "simulation/solver/async_iterates.h"
#include "tests/simulation/run/async_runs.h"

namespace weft::test {
namespace {

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
    testing::Values(AsyncCase{Method::kXpbd, &kEverything}, AsyncCase{Method::kXpbd, &kSolids},
                    AsyncCase{Method::kVbd, &kEverything}, AsyncCase{Method::kVbd, &kSolids},
                    AsyncCase{Method::kSosd, &kEverything}, AsyncCase{Method::kSosd, &kSolids},
                    AsyncCase{Method::kJpgd, &kEverything}, AsyncCase{Method::kJpgd, &kSolids, 10},
                    AsyncCase{Method::kXpbd, &kTouching}, AsyncCase{Method::kVbd, &kTouching},
                    AsyncCase{Method::kSosd, &kTouching}, AsyncCase{Method::kJpgd, &kTouching, 10}),
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
    const Division halves{{strips / 2, strips - strips / 2}};
    const auto base = make_solver(model);
    const Step in_step = base->make_step(halves.partition());
    for (const char* settings : {"settle=0", "window=4,settle=0"}) {
        AsyncIterates solver(model, make_solver(model), 2, parse_async_settings(settings));
        const auto problem = solver.problem_of(halves.partition());
        ASSERT_EQ(problem.tasks.size(), in_step.tasks().size());
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
            // Where all parts begin, one device may have led vertices of both.
            if (in_step.tasks()[static_cast<std::size_t>(step.task)].body->name == "ties") continue;
            for (const auto& range : task.writes) {
                for (int c = range.begin; c < range.end; ++c)
                    seen[{task.device, c}][task.device] = task.iteration;
            }
        }
        EXPECT_GT(looks, 0);
    }
}

}  // namespace
}  // namespace weft::test
