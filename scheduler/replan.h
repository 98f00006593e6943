#pragma once

#include <vector>

#include "scheduler/task_graph.h"

namespace weft::scheduler {

/// What is left of a graph when a processor is lost in mid-run: the tasks that are not done, barred
/// from that processor. Their data from done tasks are taken to be everywhere (the runtime goes on
/// from a state that it has saved), so edges from done tasks vanish.
///
/// done  [task]; left  sealed afterwards; original_of  [task of left] its id in `graph`.
/// Throws GraphError if a task cannot run on any other processor, or if nothing is left to do.
void remaining_graph(const TaskGraph& graph, const std::vector<bool>& done, ProcessorId lost,
                     TaskGraph& left, std::vector<TaskId>& original_of);

}  // namespace weft::scheduler
