#pragma once

// Task graphs and planners; nothing else of Weft is needed for them (component `scheduler`).
//
//   weft::scheduler::TaskGraph graph(2);                     // two processors
//   graph.set_links(0.1, 1e9);                               // latency, data per time
//   const double cost[] = {3.0, 5.0};                        // on each of them
//   const auto a = graph.add_task(cost), b = graph.add_task(cost);
//   graph.add_edge(a, b, 4e8);                               // b needs so much of what a makes
//   graph.seal();
//
//   weft::scheduler::Plan plan;
//   weft::scheduler::make_planner("heft")->plan(graph, plan);
//   plan.placements[b].processor;  plan.placements[b].start;  plan.makespan;  plan.lower_bound();
//
// Times are in a unit of your choice, the same for all. GraphError tells what is wrong with a
// graph, std::invalid_argument which planners there are.

#include "scheduler/bounds.h"
#include "scheduler/plan.h"
#include "scheduler/planner.h"
#include "scheduler/task_graph.h"
