#pragma once

#include <set>

#include "scheduler/task_graph.h"

namespace weft::scheduler::test {

// Straightforward versions of the published algorithms that follow every tie: of priorities, of
// processors, of critical paths. They return all makespans that tie rules allow, and share no
// code with the planners. Empty if there are too many ties to follow.

std::set<double> heft_makespans(const TaskGraph& graph);
std::set<double> peft_makespans(const TaskGraph& graph);
std::set<double> cpop_makespans(const TaskGraph& graph);

/// The optimum, from all orders and placements. For up to 6 tasks or so.
double brute_force_makespan(const TaskGraph& graph);

}  // namespace weft::scheduler::test
