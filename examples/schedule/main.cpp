// Plans a fork and join of four tasks on two processors, by every planner that there is.
#include <weft/schedule.h>

#include <cstdio>

int main() {
    using namespace weft::scheduler;
    TaskGraph graph(2);
    const double even[] = {2.0, 2.0};
    const TaskId fork = graph.add_task(even, {.name = "fork"});
    const TaskId left = graph.add_task(even, {.name = "left"});
    const TaskId right = graph.add_task(even, {.name = "right"});
    const TaskId join = graph.add_task(even, {.name = "join"});
    for (const TaskId middle : {left, right}) {
        graph.add_edge(fork, middle, 0.5);  // passing the data to the other processor takes 0.5
        graph.add_edge(middle, join, 0.5);
    }
    graph.seal();

    for (const std::string_view name : planner_names()) {
        Plan plan;
        make_planner(name)->plan(graph, plan);
        std::printf("%-10s %4.1f, at least %.1f:", name.data(), plan.makespan, plan.lower_bound());
        for (TaskId t = 0; t < graph.task_count(); ++t) {
            std::printf("  %s on %u at %.1f", graph.label(t).c_str(), plan.placements[t].processor,
                        plan.placements[t].start);
        }
        std::printf("\n");
    }
    Plan best;
    make_planner("optimal")->plan(graph, best);
    // One of the middle tasks runs elsewhere, so its data pass before or behind it.
    return best.makespan == 6.5 ? 0 : 1;
}
