// The planners against published numbers, and against independent versions on random graphs.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "graphs.h"
#include "reference.h"
#include "scheduler/heft.h"
#include "scheduler/in_order.h"
#include "scheduler/optimal.h"
#include "scheduler/portfolio.h"
#include "scheduler/ranks.h"

namespace weft::scheduler::test {
namespace {

double makespan(const std::string& algorithm, const TaskGraph& graph) {
    Plan plan;
    make_planner(algorithm)->plan(graph, plan);
    EXPECT_EQ(complaint(graph, plan), "") << algorithm;
    EXPECT_EQ(plan.algorithm, algorithm);
    return plan.makespan;
}

bool contains(const std::set<double>& allowed, double makespan) {
    const auto at = allowed.lower_bound(makespan * (1.0 - 1e-9));
    return at != allowed.end() && *at <= makespan * (1.0 + 1e-9);
}

/// All kinds of small graphs: hundreds of them, in every combination of what can vary.
std::vector<RandomGraph> shapes(std::uint32_t tasks) {
    std::vector<RandomGraph> all;
    for (const ProcessorId processors : {1u, 2u, 3u, 4u}) {
        for (const double ccr : {0.1, 1.0, 5.0}) {
            RandomGraph shape{.tasks = tasks, .processors = processors, .ccr = ccr};
            all.push_back(shape);
            shape.integers = true;
            shape.edge_share = 0.15;
            all.push_back(shape);
            shape.zero_share = 0.3;
            shape.shuffled = true;
            all.push_back(shape);
            shape.integers = false;
            shape.cannot_share = 0.3;
            shape.own_links = true;
            all.push_back(shape);
        }
    }
    return all;
}

template <class Check>
void for_random_graphs(std::uint32_t tasks, std::uint32_t seeds, const Check& check) {
    std::uint32_t number = 0;
    for (const RandomGraph& shape : shapes(tasks)) {
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            SCOPED_TRACE("graph " + std::to_string(number));
            check(random_graph(shape, 1000 * number + seed));
        }
        ++number;
    }
}

TEST(Goldens, Topcuoglu2002) {
    const TaskGraph graph = golden("topcuoglu-2002");
    EXPECT_EQ(makespan("heft", graph), 80.0);
    EXPECT_EQ(makespan("cpop", graph), 86.0);
    EXPECT_EQ(makespan("peft", graph), 85.0);
    EXPECT_EQ(makespan("lookahead", graph), 76.0);
    EXPECT_EQ(makespan("hps", graph), 76.0);
    EXPECT_EQ(makespan("optimal", graph), 73.0);
    EXPECT_EQ(makespan("single", graph), 127.0);
    EXPECT_LE(makespan("portfolio", graph), 76.0);
    LowerBounds bounds;
    EXPECT_EQ(bounds.path(graph), 54.0);
    EXPECT_NEAR(bounds.area(graph), 30.79, 0.005);
    std::vector<double> rank;
    upward_rank(graph, rank);
    const double published[] = {108, 77, 80, 80, 69, 63.333, 42.667, 35.667, 44.333, 14.667};
    for (TaskId t = 0; t < 10; ++t) EXPECT_NEAR(rank[t], published[t], 5e-4) << t;
}

TEST(Goldens, Arabnejad2014) {
    const TaskGraph graph = golden("arabnejad-2014");
    EXPECT_EQ(makespan("heft", graph), 133.0);
    EXPECT_EQ(makespan("peft", graph), 122.0);
    EXPECT_EQ(makespan("lookahead", graph), 127.0);
    EXPECT_EQ(makespan("hps", graph), 143.0);
    EXPECT_EQ(makespan("optimal", graph), 113.0);
    LowerBounds bounds;
    EXPECT_EQ(bounds.path(graph), 86.0);
    EXPECT_NEAR(bounds.area(graph), 60.44, 0.005);
    std::vector<double> table, rank;
    optimistic_cost_table(graph, table, rank);
    const double published[] = {72.67, 41, 37, 43.67, 31, 41.67, 17, 20.67, 16.33, 0};
    for (TaskId t = 0; t < 10; ++t) EXPECT_NEAR(rank[t], published[t], 5e-3) << t;
}

TEST(Goldens, InsertionFillsGaps) {
    const TaskGraph graph = golden("insertion");
    EXPECT_EQ(makespan("heft", graph), 22.0);
    EXPECT_EQ(makespan("optimal", graph), 22.0);
}

TEST(RandomGraphs, EveryPlannerMakesValidPlansAboveTheBounds) {
    std::vector<std::unique_ptr<Planner>> planners;
    for (const std::string_view name : planner_names()) {
        if (name != "optimal" && name != "portfolio") planners.push_back(make_planner(name));
    }
    planners.push_back(std::make_unique<Portfolio>(PortfolioBudget{.evaluations = 200}));
    Plan plan;
    for (const std::uint32_t tasks : {1u, 2u, 12u, 40u}) {
        for_random_graphs(tasks, 2, [&](const TaskGraph& graph) {
            for (const auto& planner : planners) {
                planner->plan(graph, plan);
                EXPECT_EQ(complaint(graph, plan), "") << planner->name();
                EXPECT_GE(plan.makespan * (1.0 + 1e-12), plan.path_bound) << planner->name();
                EXPECT_GE(plan.makespan * (1.0 + 1e-12), plan.area_bound) << planner->name();
            }
        });
    }
}

TEST(RandomGraphs, ListPlannersGiveWhatTiesAllow) {
    std::map<std::string, int> checked;
    for_random_graphs(9, 9, [&](const TaskGraph& graph) {
        const auto check = [&](const std::string& name, const std::set<double>& allowed) {
            if (allowed.empty()) return;
            EXPECT_TRUE(contains(allowed, makespan(name, graph))) << name;
            ++checked[name];
        };
        check("heft", heft_makespans(graph));
        check("peft", peft_makespans(graph));
        check("cpop", cpop_makespans(graph));
    });
    for (const auto& [name, count] : checked) EXPECT_GE(count, 250) << name;
}

TEST(RandomGraphs, OptimalIsTheBruteForceOptimumAndNoBoundIsAboveIt) {
    Optimal optimal;
    Plan plan;
    for_random_graphs(5, 4, [&](const TaskGraph& graph) {
        optimal.schedule(graph, plan);
        const double best = brute_force_makespan(graph);
        EXPECT_NEAR(plan.makespan, best, 1e-9 * best);
        EXPECT_TRUE(plan.proven_optimal);
        EXPECT_EQ(complaint(graph, plan), "");
        LowerBounds bounds;
        EXPECT_LE(bounds.path(graph), best * (1.0 + 1e-12));
        EXPECT_LE(bounds.area(graph), best * (1.0 + 1e-12));
    });
}

TEST(RandomGraphs, NoPlannerBeatsOptimal) {
    Optimal optimal;
    Plan plan, other;
    for_random_graphs(8, 2, [&](const TaskGraph& graph) {
        optimal.plan(graph, plan);
        EXPECT_EQ(complaint(graph, plan), "");
        ASSERT_TRUE(plan.proven_optimal);
        EXPECT_EQ(plan.gap(), 0.0);
        for (const std::string_view name : planner_names()) {
            make_planner(name)->plan(graph, other);
            EXPECT_GE(other.makespan, plan.makespan * (1.0 - 1e-9)) << name;
        }
    });
}

/// The same graph, its processors counted the other way round. For links that are all alike.
TaskGraph counted_backwards(const TaskGraph& graph) {
    TaskGraph other(graph.processor_count());
    other.set_links(graph.latency(0, 1), graph.bandwidth(0, 1));
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        const std::span<const double> costs = graph.costs(t);
        other.add_task(std::vector<double>(costs.rbegin(), costs.rend()));
    }
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        for (const Arc& arc : graph.successors(t)) other.add_edge(t, arc.task, arc.data);
    }
    other.seal();
    return other;
}

/// On graphs that are too large for the portfolio to find every optimum: a bound of the search that
/// is too high for one processor is noticed only where something better is left to be found.
TEST(Optimal, IsTheSameHoweverProcessorsAreNumbered) {
    Optimal optimal;
    Plan plan, other, first;
    int searched = 0;
    for (const double cannot : {0.0, 0.3}) {
        for (std::uint32_t seed = 0; seed < 50; ++seed) {
            const TaskGraph graph =
                random_graph({.tasks = 10, .processors = 2, .cannot_share = cannot}, seed);
            Portfolio({.evaluations = 5000}).plan(graph, first);
            optimal.plan(graph, plan);
            searched += plan.makespan < first.makespan * (1.0 - 1e-9) ? 1 : 0;
            optimal.plan(counted_backwards(graph), other);
            EXPECT_NEAR(other.makespan, plan.makespan, 1e-9 * plan.makespan) << seed;
            EXPECT_TRUE(plan.proven_optimal && other.proven_optimal) << seed;
        }
    }
    EXPECT_GE(searched, 5) << "graphs whose optimum the portfolio does not find";
}

TEST(Optimal, SaysWhenItGivesUp) {
    const TaskGraph graph = random_graph({.tasks = 40, .processors = 3}, 3);
    Optimal optimal({.nodes = 1000, .seconds = 0.0});
    Plan plan, portfolio;
    optimal.plan(graph, plan);
    Portfolio({.evaluations = 5000}).plan(graph, portfolio);
    EXPECT_TRUE(plan.gave_up);
    EXPECT_FALSE(plan.proven_optimal);
    EXPECT_LE(plan.makespan, portfolio.makespan);
    EXPECT_EQ(complaint(graph, plan), "");
    EXPECT_GT(plan.gap(), 0.0);
}

TEST(Portfolio, IsWithinTwoPercentOfTheOptimumOnAverage) {
    Portfolio portfolio;
    Optimal optimal;
    Plan plan, best;
    for (const ProcessorId processors : {2u, 3u}) {
        for (const double ccr : {0.1, 1.0, 5.0}) {
            double sum = 0.0;
            int count = 0;
            for (std::uint32_t seed = 0; seed < 12; ++seed) {
                for (const double edges : {0.15, 0.3}) {
                    const TaskGraph graph = random_graph(
                        {.tasks = 10, .processors = processors, .ccr = ccr, .edge_share = edges},
                        seed);
                    portfolio.plan(graph, plan);
                    optimal.plan(graph, best);
                    sum += plan.makespan / best.makespan;
                    ++count;
                }
            }
            EXPECT_LE(sum / count, 1.02) << processors << " processors, CCR " << ccr;
        }
    }
}

TEST(Portfolio, NeverPredictsWorseThanItsPartsWhateverTheBudget) {
    Plan plan, heft, single;
    for (const std::uint32_t evaluations : {0u, 1u, 4u, 10u, 100u}) {
        Portfolio portfolio({.evaluations = evaluations});
        for (std::uint32_t seed = 0; seed < 20; ++seed) {
            const TaskGraph graph = random_graph({.tasks = 30, .processors = 2}, seed);
            portfolio.plan(graph, plan);
            EXPECT_EQ(complaint(graph, plan), "");
            EXPECT_LE(plan.makespan, makespan("heft", graph));
            if (evaluations < 4) continue;
            EXPECT_LE(plan.makespan, makespan("single", graph));
        }
    }
}

TEST(Portfolio, IsDeterministic) {
    const TaskGraph graph = random_graph({.tasks = 60, .processors = 2}, 5);
    Portfolio used({.evaluations = 300});
    Plan first, second;
    used.plan(random_graph({.tasks = 20, .processors = 4}, 9), first);
    used.plan(graph, first);
    Portfolio({.evaluations = 300}).plan(graph, second);
    EXPECT_EQ(first.makespan, second.makespan);
    EXPECT_EQ(first.order, second.order);
}

TEST(Heft, TiesGoToTheFirstTaskAndTheFirstProcessor) {
    TaskGraph graph(2);
    for (int i = 0; i < 3; ++i) graph.add_task(std::vector{2.0, 2.0});
    graph.seal();
    Plan plan;
    Heft().plan(graph, plan);
    EXPECT_EQ(plan.placements[0].processor, 0u);
    EXPECT_EQ(plan.placements[1].processor, 1u);
    EXPECT_EQ(plan.placements[2].processor, 0u);
    EXPECT_EQ(plan.makespan, 4.0);
}

TEST(Single, UsesAnotherProcessorOnlyWhereItMust) {
    TaskGraph graph(2);
    const TaskId a = graph.add_task(std::vector{5.0, 1.0});
    const TaskId b = graph.add_task(std::vector{5.0, kCannotRun});
    const TaskId c = graph.add_task(std::vector{5.0, 1.0});
    graph.add_edge(a, b, 1.0);
    graph.add_edge(b, c, 1.0);
    graph.seal();
    Plan plan;
    make_planner("single")->plan(graph, plan);
    EXPECT_EQ(plan.makespan, 1.0 + 1.0 + 5.0 + 1.0 + 1.0);
    EXPECT_EQ(plan.placements[b].processor, 0u);
}

TEST(Planners, UnknownNameIsRefused) {
    EXPECT_THROW(make_planner("fastest"), std::invalid_argument);
}

TEST(InOrder, KeepsTheCallersOrderOnEveryProcessor) {
    for_random_graphs(12, 2, [](const TaskGraph& graph) {
        InOrder in_order;
        Plan plan;
        in_order.plan(graph, plan);
        EXPECT_EQ(complaint(graph, plan), "");
        EXPECT_EQ(in_order.makespan(graph), plan.makespan);
        EXPECT_LE(plan.lower_bound(), plan.makespan);
        for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
            const auto tasks = plan.tasks_on(p);
            EXPECT_TRUE(std::ranges::is_sorted(
                tasks, {}, [&](TaskId task) { return graph.topological_index(task); }));
        }
    });
}

}  // namespace
}  // namespace weft::scheduler::test
