#include "scheduler/heft.h"

namespace weft::scheduler {

void Heft::schedule(const TaskGraph& graph, Plan& plan) {
    if (rule_ == Rank::kGaussSeidel) {
        gauss_seidel_rank_(graph, rank_);
    } else {
        upward_rank(graph, rank_);
    }
    order_by_rank(graph, rank_, order_);
    builder_.begin(graph);
    for (const TaskId task : order_) builder_.place_earliest(task);
    builder_.finish(plan, name());
}

}  // namespace weft::scheduler
