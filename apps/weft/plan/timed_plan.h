#pragma once

#include <string>
#include <vector>

#include "apps/weft/plan/graph_file.h"
#include "scheduler/plan.h"

namespace weft {

/// A plan, and how long it took to make.
struct TimedPlan {
    scheduler::Plan plan;
    double seconds = 0.0;
};

/// All that make_plan() knows.
std::vector<std::string> algorithm_names();

/// time_limit: after which portfolio and optimal settle for the best plan so far [s]. Throws
/// scheduler::GraphError where the algorithm refuses the graph.
TimedPlan make_plan(const GraphFile& file, const std::string& algorithm, double time_limit);

}  // namespace weft
