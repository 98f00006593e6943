#include "scheduler/portfolio.h"

#include <algorithm>
#include <utility>

namespace weft::scheduler {

void Portfolio::schedule(const TaskGraph& graph, Plan& plan) {
    using namespace std::chrono;
    if (budget_.seconds > 0.0) {
        deadline_ = steady_clock::now() +
                    duration_cast<steady_clock::duration>(duration<double>(budget_.seconds));
    }
    left_ = budget_.evaluations - std::min(budget_.evaluations, 1u);
    heft_.schedule(graph, plan);
    const double path = bounds_.path(graph);
    const double area = bounds_.area(graph);
    bound_ = std::max(path, area) * (1.0 + 1e-12);  // but for rounding

    const ProcessorId processors = graph.processor_count();
    const auto lookahead_cost =
        static_cast<std::uint32_t>(processors * (1 + graph.edge_count() / graph.task_count()));
    try_planner(single_, processors + 1, graph, plan);
    try_planner(peft_, 1, graph, plan);
    try_planner(cpop_, 1, graph, plan);
    try_planner(hps_, 1, graph, plan);
    try_planner(lookahead_, lookahead_cost, graph, plan);
    if (!out_of_time() &&
        search_.improve(graph, plan, left_, bound_, [this] { return out_of_time(); })) {
        plan.found_by = "search";
    }
    plan.algorithm = name();
    plan.path_bound = path;
    plan.area_bound = area;
    plan.proven_optimal = plan.meets_bound();
}

void Portfolio::try_planner(Planner& planner, std::uint32_t evaluations, const TaskGraph& graph,
                            Plan& plan) {
    if (evaluations > left_ || plan.makespan <= bound_ || out_of_time()) return;
    left_ -= evaluations;
    planner.schedule(graph, candidate_);
    if (candidate_.makespan < plan.makespan) std::swap(candidate_, plan);
}

bool Portfolio::out_of_time() const {
    return budget_.seconds > 0.0 && std::chrono::steady_clock::now() >= deadline_;
}

}  // namespace weft::scheduler
