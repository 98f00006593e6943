#include "scheduler/peft.h"

#include "scheduler/ranks.h"

namespace weft::scheduler {

void Peft::schedule(const TaskGraph& graph, Plan& plan) {
    optimistic_cost_table(graph, table_, rank_);
    builder_.begin(graph);
    ready_.begin(graph, rank_);
    while (!ready_.empty()) place_optimistically(graph, ready_.take());
    builder_.finish(plan, name());
}

void Peft::place_optimistically(const TaskGraph& graph, TaskId task) {
    const ProcessorId processors = graph.processor_count();
    const double* after = table_.data() + std::size_t{task} * processors;
    const std::span<const double> ready = builder_.ready_times(task);
    double best_end = kCannotRun;
    ProcessorId best = 0;
    ScheduleBuilder::Gap best_gap;
    for (ProcessorId p = 0; p < processors; ++p) {
        if (!graph.can_run(task, p)) continue;
        const ScheduleBuilder::Gap gap = builder_.find_gap(p, ready[p], graph.cost(task, p));
        const double optimistic_end = gap.start + graph.cost(task, p) + after[p];
        if (optimistic_end >= best_end) continue;
        best_end = optimistic_end;
        best = p;
        best_gap = gap;
    }
    builder_.place(task, best, best_gap);
}

}  // namespace weft::scheduler
