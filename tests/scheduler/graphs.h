#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "scheduler/plan.h"
#include "scheduler/task_graph.h"

namespace weft::scheduler::test {

/// A graph of tests/scheduler/data, read by itself: the program's reader is not under test here.
TaskGraph golden(const std::string& name);

struct RandomGraph {
    std::uint32_t tasks = 10;
    ProcessorId processors = 2;
    double ccr = 1.0;            ///< mean communication time / mean cost
    double edge_share = 0.3;     ///< probability of an edge between two tasks
    double heterogeneity = 1.0;  ///< costs of a task lie within mean * (1 +- h / 2)
    bool integers = false;       ///< small integers: many ties
    double zero_share = 0.0;     ///< share of tasks without cost
    double cannot_share = 0.0;   ///< share of (task, processor) that cannot run
    bool own_links = false;      ///< every ordered pair has its own latency and bandwidth
    bool shuffled = false;       ///< ids are not in topological order
};

TaskGraph random_graph(const RandomGraph& shape, std::uint32_t seed);

/// Empty if the plan is a valid schedule of the graph; else what is wrong. Shares no code with the
/// planners.
std::string complaint(const TaskGraph& graph, const Plan& plan);

}  // namespace weft::scheduler::test
