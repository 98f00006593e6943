#pragma once

#include <string>

#include "apps/weft/plan/graph_file.h"
#include "scheduler/plan.h"

namespace weft {

/// The tasks in order of their start: processor, start, end.
std::string plan_table(const GraphFile& file, const scheduler::Plan& plan);

/// One line per processor, time to the right; at most 100 columns.
std::string plan_gantt(const GraphFile& file, const scheduler::Plan& plan);

}  // namespace weft
