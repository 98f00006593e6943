#include "scheduler/single.h"

namespace weft::scheduler {

void Single::schedule(const TaskGraph& graph, Plan& plan) {
    ProcessorId best = 0;
    double shortest = kCannotRun;
    for (ProcessorId p = 0; p < graph.processor_count(); ++p) {
        const double makespan = build_on(graph, p);
        if (makespan >= shortest) continue;
        shortest = makespan;
        best = p;
    }
    schedule_on(graph, best, plan);
}

void Single::schedule_on(const TaskGraph& graph, ProcessorId processor, Plan& plan) {
    build_on(graph, processor);
    builder_.finish(plan, name());
}

double Single::build_on(const TaskGraph& graph, ProcessorId processor) {
    builder_.begin(graph);
    for (const TaskId task : graph.topological_order()) {
        if (graph.can_run(task, processor)) {
            builder_.place_on(task, processor);
        } else {
            builder_.place_earliest(task);
        }
    }
    return builder_.makespan();
}

}  // namespace weft::scheduler
