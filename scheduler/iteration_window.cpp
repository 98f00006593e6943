#include "scheduler/iteration_window.h"

#include <algorithm>
#include <map>

namespace weft::scheduler {
namespace {

bool within_iteration(const TaskGraph& graph, TaskId task, std::span<const Arc> arcs) {
    return std::ranges::any_of(
        arcs, [&](const Arc& arc) { return graph.iteration(arc.task) == graph.iteration(task); });
}

void copy_graph(const TaskGraph& graph, TaskGraph& copy) {
    copy.clear(graph.processor_count());
    copy.copy_links(graph);
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        copy.add_task(
            graph.costs(t),
            {.kind = graph.kind(t), .iteration = graph.iteration(t), .name = graph.name(t)});
    }
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        for (const Arc& arc : graph.successors(t)) copy.add_edge(t, arc.task, arc.data);
    }
}

}  // namespace

void IterationWindow::limit(const TaskGraph& graph, std::int32_t open, TaskGraph& limited) {
    find_ends(graph);
    copy_graph(graph, limited);
    add_waits(open, limited);
    limited.seal();
}

void IterationWindow::find_ends(const TaskGraph& graph) {
    std::map<std::int32_t, Ends> by_iteration;
    for (const TaskId t : graph.topological_order()) {
        const std::int32_t i = graph.iteration(t);
        if (i < 0) continue;
        Ends& ends = by_iteration[i];
        ends.iteration = i;
        if (!within_iteration(graph, t, graph.predecessors(t))) ends.first.push_back(t);
        if (!within_iteration(graph, t, graph.successors(t))) ends.last.push_back(t);
    }
    ends_.clear();
    for (auto& [iteration, ends] : by_iteration) ends_.push_back(std::move(ends));
}

/// Of the iterations that must have ended, the latest one has itself waited for all but those that
/// were open together with it.
void IterationWindow::add_waits(std::int32_t open, TaskGraph& limited) const {
    std::size_t ended = 0;
    for (const Ends& later : ends_) {
        while (ends_[ended].iteration + open <= later.iteration) ++ended;
        for (std::size_t i = ended; i-- > 0;) {
            if (ends_[i].iteration + open <= ends_[ended - 1].iteration) break;
            for (const TaskId from : ends_[i].last) {
                for (const TaskId to : later.first) limited.add_edge(from, to, 0.0);
            }
        }
    }
}

}  // namespace weft::scheduler
