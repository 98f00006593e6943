#include "scheduler/replan.h"

namespace weft::scheduler {

void remaining_graph(const TaskGraph& graph, const std::vector<bool>& done, ProcessorId lost,
                     TaskGraph& left, std::vector<TaskId>& original_of) {
    left.clear(graph.processor_count());
    left.copy_links(graph);
    original_of.clear();
    std::vector<TaskId> new_id(graph.task_count());
    std::vector<double> cost;
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        if (done[t]) continue;
        cost.assign(graph.costs(t).begin(), graph.costs(t).end());
        cost.at(lost) = kCannotRun;
        new_id[t] = left.add_task(
            cost, {.kind = graph.kind(t), .iteration = graph.iteration(t), .name = graph.name(t)});
        original_of.push_back(t);
    }
    for (const TaskId from : original_of) {
        for (const Arc& arc : graph.successors(from)) {
            if (!done[arc.task]) left.add_edge(new_id[from], new_id[arc.task], arc.data);
        }
    }
    left.seal();
}

}  // namespace weft::scheduler
