#include "scheduler/plan.h"

#include <numeric>

namespace weft::scheduler {

void Plan::order_by_start(ProcessorId processors) {
    order.resize(placements.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, [&](TaskId a, TaskId b) {
        const Placement& p = placements[a];
        const Placement& q = placements[b];
        if (p.processor != q.processor) return p.processor < q.processor;
        return p.start != q.start ? p.start < q.start : a < b;
    });
    order_begin.assign(std::size_t{processors} + 1, 0);
    for (const Placement& placement : placements) ++order_begin[placement.processor + 1];
    std::partial_sum(order_begin.begin(), order_begin.end(), order_begin.begin());
}

}  // namespace weft::scheduler
