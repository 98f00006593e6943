// The map of asynchronous iterations: what it must hold for all sorts of plans, and that the check
// catches maps that do not.

#include "scheduler/exchange_map.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <stdexcept>

namespace weft::scheduler {
namespace {

using Kind = ExchangeStep::Kind;

/// As strips: every device has a cell of its own and one at each cut; a task for its own cells, and
/// one for the cut behind them, which writes into the next one's first cell.
ExchangeProblem strips(int devices, int iterations) {
    ExchangeProblem problem;
    problem.devices = devices;
    for (int d = 0; d < devices; ++d) problem.owners.insert(problem.owners.end(), 3, d);
    const auto add = [&](int iteration, int device, CellRange cells, bool synchronous) {
        ExchangeTask task;
        task.iteration = iteration;
        task.device = device;
        task.synchronous = synchronous;
        task.reads = task.writes = {cells};
        problem.tasks.push_back(task);
    };
    for (int d = 0; d < devices; ++d) add(0, d, {3 * d, 3 * d + 3}, true);
    for (int i = 0; i < iterations; ++i) {
        for (int d = 0; d < devices; ++d) {
            if (d + 1 < devices) add(i, d, {3 * d + 2, 3 * d + 4}, false);
            add(i, d, {3 * d, 3 * d + 3}, false);
        }
    }
    for (int d = 0; d < devices; ++d) add(iterations, d, {3 * d, 3 * d + 3}, true);
    return problem;
}

/// As the paper's: every task writes everything, devices do kinds of tasks.
ExchangeProblem families(int devices, int iterations) {
    ExchangeProblem problem;
    problem.devices = devices;
    problem.owners = {0};
    for (int i = 0; i < iterations; ++i) {
        for (int d = 0; d < devices; ++d) {
            ExchangeTask task;
            task.iteration = i;
            task.device = d;
            task.reads = task.writes = {{0, 1}};
            problem.tasks.push_back(task);
        }
    }
    return problem;
}

void plan_at_random(ExchangeProblem& problem, int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> duration(0.2, 3.0);
    std::vector<double> durations;
    for (std::size_t t = 0; t < problem.tasks.size(); ++t) durations.push_back(duration(random));
    plan_in_turn(problem, durations);
}

TEST(ExchangeMap, HoldsWhateverThePlan) {
    for (int seed = 0; seed < 40; ++seed) {
        for (const int devices : {1, 2, 3, 5}) {
            for (const int window : {1, 2, 3}) {
                for (const bool dropping : {false, true}) {
                    for (const bool by_strips : {false, true}) {
                        auto problem = by_strips ? strips(devices, 6) : families(devices, 6);
                        problem.window = window;
                        problem.dropping = dropping;
                        problem.wait = 0.1 * (seed % 7);
                        problem.most_slots = 64;
                        plan_at_random(problem, seed);
                        EXPECT_EQ(find_fault(problem, make_exchange_map(problem)), "")
                            << seed << ' ' << devices << ' ' << window << ' ' << dropping << ' '
                            << by_strips;
                    }
                }
            }
        }
    }
}

/// Tasks of two devices in turn, one per iteration, which all write the same.
TEST(ExchangeMap, TasksNeedWhatIsFurtherBackThanTheWindow) {
    ExchangeProblem problem = families(2, 6);
    for (ExchangeTask& task : problem.tasks) task.kind = task.device;  // each its own: in turn
    problem.window = 3;
    // Task 2 i + d is of iteration i and device d.
    const auto needed = needed_tasks(problem);
    EXPECT_EQ(needed[8], (std::vector{1, 3}));      // of iterations 0 and 1 = 4 - 3
    EXPECT_EQ(needed[11], (std::vector{0, 2, 4}));  // 0, 1 and 2 = 5 - 3
    EXPECT_EQ(needed[4], std::vector<int>{});
    problem.iterations_in_turn = true;
    EXPECT_EQ(needed_tasks(problem)[4], (std::vector{1, 3}));
}

/// Device 1 has the cell and changes it; device 0, whose place is where the cell has to be in the
/// end, only looks at it, and has it then.
TEST(ExchangeMap, NothingIsCopiedInTheEndThatIsThereAlready) {
    ExchangeProblem problem = families(2, 1);
    problem.owners = {1};
    std::swap(problem.tasks[0].device, problem.tasks[1].device);
    problem.tasks[1].writes.clear();
    for (ExchangeTask& task : problem.tasks) task.synchronous = true;
    plan_in_turn(problem, {1.0, 1.0});
    const ExchangeMap map = make_exchange_map(problem);
    EXPECT_EQ(find_fault(problem, map), "");
    std::vector<std::pair<int, int>> copies;
    for (const ExchangeStep& step : map.steps) {
        if (step.kind == Kind::kCopy) copies.emplace_back(step.from, step.to);
    }
    EXPECT_EQ(copies, (std::vector<std::pair<int, int>>{{0, 1}, {1, 0}}));
}

TEST(ExchangeMap, SynchronousTasksNeedAllAndAreNeededByAll) {
    ExchangeProblem problem = families(2, 6);
    problem.window = 6;
    EXPECT_EQ(needed_tasks(problem)[8], std::vector<int>{});
    problem.tasks[8].synchronous = true;
    EXPECT_EQ(needed_tasks(problem)[8], (std::vector{1, 3, 5, 7}));
    EXPECT_EQ(needed_tasks(problem)[10], std::vector<int>{});  // its own device's
    EXPECT_EQ(needed_tasks(problem)[11], std::vector<int>{8});
}

/// FNV-1a over all steps.
std::uint64_t fingerprint(const ExchangeMap& map, std::uint64_t print) {
    const auto add = [&](int number) {
        print = (print ^ static_cast<std::uint32_t>(number)) * 0x100000001b3u;
    };
    for (const ExchangeStep& s : map.steps) {
        for (const int number :
             {static_cast<int>(s.kind), s.task, s.device, s.cells.begin, s.cells.end, s.from,
              s.start, s.to, s.from_value, s.start_value, s.to_value}) {
            add(number);
        }
    }
    add(map.slots);
    add(map.virtual_starts);
    return print;
}

/// Maps define the results of asynchronous runs: where a fingerprint moves, so do their state
/// hashes, and their traces cannot be replayed any more.
std::uint64_t fingerprint_of_all(bool by_strips, bool dropping) {
    std::uint64_t print = 0xcbf29ce484222325u;
    std::uint32_t random = 1;
    for (const int devices : {2, 3, 5}) {
        for (const int window : {2, 3, 5}) {
            for (const double wait : {0.0, 0.5, 2.0}) {
                auto problem = by_strips ? strips(devices, 6) : families(devices, 6);
                problem.window = window;
                problem.dropping = dropping;
                problem.wait = wait;
                problem.most_slots = 64;
                std::vector<double> durations;
                for (std::size_t t = 0; t < problem.tasks.size(); ++t) {
                    random = random * 1664525u + 1013904223u;
                    durations.push_back(0.25 + (random >> 28) / 8.0);
                }
                plan_in_turn(problem, durations);
                print = fingerprint(make_exchange_map(problem), print);
            }
        }
    }
    return print;
}

TEST(ExchangeMap, IsThatOfBefore) {
    EXPECT_EQ(fingerprint_of_all(false, false), 14020675832138902593u);
    EXPECT_EQ(fingerprint_of_all(false, true), 16384251003621461721u);
    EXPECT_EQ(fingerprint_of_all(true, false), 7346584962834759750u);
    EXPECT_EQ(fingerprint_of_all(true, true), 18030890038418220222u);
}

TEST(ExchangeMap, AWindowOfOneOnlyCopies) {
    for (int seed = 0; seed < 10; ++seed) {
        auto problem = strips(3, 5);
        problem.window = 1;
        plan_at_random(problem, seed);
        for (const ExchangeStep& step : make_exchange_map(problem).steps) {
            EXPECT_NE(step.kind, Kind::kMerge);
        }
    }
}

TEST(ExchangeMap, OneDeviceHasNothingToExchange) {
    auto problem = strips(1, 4);
    plan_at_random(problem, 1);
    const ExchangeMap map = make_exchange_map(problem);
    EXPECT_EQ(map.steps.size(), problem.tasks.size());
    EXPECT_EQ(map.slots, 0);
}

/// An owner that is fed in time merges nothing: only who has moved a cell meanwhile does.
TEST(ExchangeMap, OnlyCellsThatSeveralDevicesTouchAreExchanged) {
    auto problem = strips(2, 6);
    plan_at_random(problem, 3);
    for (const ExchangeStep& step : make_exchange_map(problem).steps) {
        if (step.kind == Kind::kTask) continue;
        const ExchangeTask* task = step.task < static_cast<int>(problem.tasks.size())
                                       ? &problem.tasks[static_cast<std::size_t>(step.task)]
                                       : nullptr;
        if (task == nullptr || task->synchronous) continue;
        EXPECT_EQ(step.cells, (CellRange{3, 4}));
    }
}

/// However long they wait for each other, two devices were once where each merge starts.
TEST(ExchangeMap, TwoDevicesNeedNoStartsThatTheyWereNeverAt) {
    for (const bool by_strips : {false, true}) {
        for (const int window : {2, 3, 4}) {
            auto problem = by_strips ? strips(2, 32) : families(2, 32);
            problem.dropping = false;
            problem.window = window;
            problem.wait = 1.3 * (window - 1);
            problem.most_slots = 8 * window;
            plan_in_turn(problem, std::vector<double>(problem.tasks.size(), 0.6));
            const ExchangeMap map = make_exchange_map(problem);
            EXPECT_EQ(map.virtual_starts, 0);
            EXPECT_EQ(find_fault(problem, map), "");
        }
    }
}

/// An iteration as the paper's: a long task (stretching), a shorter one (bending), and one that
/// must come last (obstacles); all of them touch everything.
ExchangeProblem kinds(int iterations) {
    ExchangeProblem problem;
    problem.devices = 2;
    problem.owners = {1};
    problem.dropping = false;
    problem.wait = 0.05;
    problem.most_slots = 64;
    for (int i = 0; i < iterations; ++i) {
        for (int kind = 0; kind < 3; ++kind) {
            ExchangeTask task;
            task.iteration = i;
            task.kind = kind;
            task.stage = kind == 2 ? 1 : 0;
            task.reads = task.writes = {{0, 1}};
            problem.tasks.push_back(task);
        }
    }
    return problem;
}

std::vector<std::vector<double>> durations_of_kinds(const ExchangeProblem& problem) {
    const std::vector<std::vector<double>> of_kind{{1.0, 0.5}, {0.8, 0.4}, {0.4, 0.2}};
    std::vector<std::vector<double>> durations;
    for (const ExchangeTask& task : problem.tasks) {
        durations.push_back(of_kind[static_cast<std::size_t>(task.kind)]);
    }
    return durations;
}

class Placed : public testing::TestWithParam<PlacingRank> {};

TEST_P(Placed, MapsOfPlacedTasksHold) {
    for (const int window : {1, 2, 3}) {
        for (const bool in_turn : {false, true}) {
            auto problem = kinds(8);
            problem.window = window;
            problem.iterations_in_turn = in_turn;
            place_by_rank(problem, durations_of_kinds(problem), GetParam());
            EXPECT_EQ(find_fault(problem, make_exchange_map(problem)), "");
        }
    }
}

/// The window, the stages, and that the tasks of a kind follow each other, also on one device.
TEST_P(Placed, NothingStartsBeforeWhatItMustSee) {
    auto problem = kinds(8);
    place_by_rank(problem, durations_of_kinds(problem), GetParam());
    int overlaps = 0;
    for (const ExchangeTask& later : problem.tasks) {
        for (const ExchangeTask& earlier : problem.tasks) {
            if (earlier.iteration > later.iteration || &earlier == &later) continue;
            const bool is_same_iteration = earlier.iteration == later.iteration;
            const bool must = (earlier.kind == later.kind && !is_same_iteration) ||
                              (is_same_iteration && earlier.stage < later.stage) ||
                              earlier.iteration <= later.iteration - 2;
            const double wait = earlier.device == later.device ? 0.0 : problem.wait;
            if (must) {
                EXPECT_GE(later.start, earlier.end + wait - 1e-12);
            } else if (!is_same_iteration && later.start < earlier.end) {
                ++overlaps;
            }
        }
    }
    EXPECT_GT(overlaps, 0);
}

TEST_P(Placed, IterationsInTurnDoNotOverlap) {
    auto problem = kinds(8);
    problem.iterations_in_turn = true;
    place_by_rank(problem, durations_of_kinds(problem), GetParam());
    for (const ExchangeTask& later : problem.tasks) {
        for (const ExchangeTask& earlier : problem.tasks) {
            if (earlier.iteration >= later.iteration) continue;
            EXPECT_GE(later.start, earlier.end - 1e-12);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(By, Placed,
                         testing::Values(PlacingRank::kUpward, PlacingRank::kGaussSeidel),
                         [](const auto& tested) {
                             return tested.param == PlacingRank::kUpward ? "UpwardRank"
                                                                         : "GaussSeidelRank";
                         });

/// Starts of tasks that are before one of an earlier iteration.
int inversions(const ExchangeProblem& problem) {
    int count = 0;
    for (const ExchangeTask& a : problem.tasks) {
        for (const ExchangeTask& b : problem.tasks) {
            if (a.iteration < b.iteration && a.start > b.start) ++count;
        }
    }
    return count;
}

/// Figure 9: without the rank, tasks that nothing waits for (obstacles) are put off behind those of
/// the next iterations.
TEST(PlacingRanks, TheGaussSeidelRankKeepsIterationsTogether) {
    auto problem = kinds(12);
    problem.window = 4;
    place_by_rank(problem, durations_of_kinds(problem), PlacingRank::kUpward);
    const int without = inversions(problem);
    place_by_rank(problem, durations_of_kinds(problem), PlacingRank::kGaussSeidel);
    const int with = inversions(problem);
    EXPECT_LT(2 * with, without);
}

/// Where slots are short, one is used again before it is safe to do so without a wait.
TEST(ExchangeMap, FewerSlotsThanWouldBePleasantStillDo) {
    ExchangeProblem problem = strips(5, 8);
    problem.window = 4;
    problem.dropping = false;
    problem.wait = 2.0;
    problem.most_slots = 64;
    plan_in_turn(problem, std::vector<double>(problem.tasks.size(), 1.0));
    const int pleasant = make_exchange_map(problem).slots;
    problem.most_slots = pleasant - 1;
    const ExchangeMap map = make_exchange_map(problem);
    EXPECT_EQ(map.slots, pleasant - 1);
    EXPECT_EQ(find_fault(problem, map), "");
}

TEST(ExchangeMap, TooFewSlotsAreRefused) {
    auto problem = families(3, 6);
    problem.most_slots = 1;
    plan_at_random(problem, 2);
    EXPECT_THROW(make_exchange_map(problem), TooFewSlots);
}

TEST(ExchangeMap, ATaskThatStartsTooEarlyIsRefused) {
    auto problem = strips(2, 4);
    plan_at_random(problem, 2);
    problem.tasks.back().start = 0.0;
    EXPECT_THROW(make_exchange_map(problem), std::logic_error);
}

class Mutation : public testing::TestWithParam<bool> {
protected:
    Mutation() {
        problem_ = GetParam() ? strips(3, 6) : families(3, 6);
        problem_.dropping = false;
        problem_.wait = 0.3;
        problem_.most_slots = 64;
        plan_at_random(problem_, 5);
        map_ = make_exchange_map(problem_);
    }
    /// Changes one step of those that `which` chooses, each in turn.
    template <class Which, class Change>
    void expect_faults(Which which, Change change) {
        int tried = 0;
        for (std::size_t s = 0; s < map_.steps.size(); ++s) {
            if (!which(map_.steps[s])) continue;
            ++tried;
            ExchangeMap wrong = map_;
            change(wrong, s);
            EXPECT_NE(find_fault(problem_, wrong), "") << "step " << s;
        }
        EXPECT_GT(tried, 0);
    }

    ExchangeProblem problem_;
    ExchangeMap map_;
};

TEST_P(Mutation, AnInputDroppedIsFound) {
    expect_faults([](const ExchangeStep& s) { return s.kind != Kind::kTask; },
                  [](ExchangeMap& map, std::size_t s) {
                      map.steps.erase(map.steps.begin() + static_cast<std::ptrdiff_t>(s));
                  });
}

/// The start point of the merge before, which lies in another slot.
TEST_P(Mutation, AStalePointIsFound) {
    const auto slots = map_.slots;
    expect_faults([](const ExchangeStep& s) { return s.kind == Kind::kMerge; },
                  [&](ExchangeMap& map, std::size_t s) {
                      auto& start = map.steps[s].start;
                      start = start + 1 < problem_.devices + slots ? start + 1 : start - 1;
                  });
}

/// A value that was kept is written over before its last reader came.
TEST_P(Mutation, ASlotReusedEarlyIsFound) {
    const auto& steps = map_.steps;
    int tried = 0;
    for (std::size_t read = 0; read < steps.size(); ++read) {
        const ExchangeStep& reader = steps[read];
        if (reader.kind == Kind::kTask || reader.from < problem_.devices) continue;
        for (std::size_t w = 0; w < read; ++w) {
            const ExchangeStep& writer = steps[w];
            if (writer.kind != Kind::kCopy || writer.to < problem_.devices) continue;
            if (writer.to == reader.from || writer.from_value == reader.from_value) continue;
            if (writer.cells != reader.cells) continue;
            // Not before the value itself was put there.
            std::size_t put = read;
            for (std::size_t p = w; p-- > 0;) {
                if (steps[p].to == reader.from && steps[p].to_value == reader.from_value) put = p;
            }
            if (put >= w) continue;
            ExchangeMap wrong = map_;
            wrong.steps[w].to = reader.from;
            EXPECT_NE(find_fault(problem_, wrong), "") << w << " before " << read;
            ++tried;
        }
    }
    EXPECT_GT(tried, 0);
}

TEST_P(Mutation, ATaskLeftOutOrDoneTwiceIsFound) {
    expect_faults([](const ExchangeStep& s) { return s.kind == Kind::kTask; },
                  [](ExchangeMap& map, std::size_t s) {
                      map.steps.erase(map.steps.begin() + static_cast<std::ptrdiff_t>(s));
                  });
    expect_faults([](const ExchangeStep& s) { return s.kind == Kind::kTask; },
                  [](ExchangeMap& map, std::size_t s) {
                      const ExchangeStep again = map.steps[s];
                      map.steps.insert(map.steps.begin() + static_cast<std::ptrdiff_t>(s), again);
                  });
}

INSTANTIATE_TEST_SUITE_P(Of, Mutation, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Strips" : "Families"; });

}  // namespace
}  // namespace weft::scheduler
