// Plans a fork and join of four tasks on two processors, with weft::scheduler and nothing else.
#include <cstdio>

#include "scheduler/planner.h"

int main() {
    using namespace weft::scheduler;
    TaskGraph graph(2);
    const double even[] = {2.0, 2.0};
    const TaskId fork = graph.add_task(even);
    const TaskId left = graph.add_task(even);
    const TaskId right = graph.add_task(even);
    const TaskId join = graph.add_task(even);
    for (const TaskId middle : {left, right}) {
        graph.add_edge(fork, middle, 0.5);
        graph.add_edge(middle, join, 0.5);
    }
    graph.seal();

    Plan plan;
    make_planner("heft")->plan(graph, plan);
    std::printf("makespan %g, at least %g\n", plan.makespan, plan.lower_bound());
    // One of the middle tasks runs elsewhere, so its data passes before or after it: 2 + 2 + 2 +
    // 0.5.
    return plan.makespan == 6.5 ? 0 : 1;
}
