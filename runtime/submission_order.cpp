#include "runtime/submission_order.h"

#include "runtime/error.h"

namespace weft {

namespace {

/// Walks along the devices' rows.
class Walk {
public:
    Walk(const Step& step, const scheduler::Plan& plan)
        : plan_(plan),
          missing_(step.tasks().size(), 0),
          successors_(step.tasks().size()),
          next_(plan.order_begin.begin(), plan.order_begin.end() - 1) {
        for (const Dependency& d : step.dependencies()) {
            ++missing_[static_cast<std::size_t>(d.to)];
            successors_[static_cast<std::size_t>(d.from)].push_back(d.to);
        }
    }

    /// The next task; -1 if none can follow.
    int take() {
        std::size_t from = next_.size();
        for (std::size_t row = 0; row < next_.size(); ++row) {
            if (is_ready(row) && (from == next_.size() || comes_before(row, from))) from = row;
        }
        if (from == next_.size()) return -1;
        const scheduler::TaskId task = plan_.order[next_[from]++];
        for (const int to : successors_[task]) --missing_[static_cast<std::size_t>(to)];
        return static_cast<int>(task);
    }

private:
    scheduler::TaskId head(std::size_t row) const { return plan_.order[next_[row]]; }
    bool is_ready(std::size_t row) const {
        return next_[row] < plan_.order_begin[row + 1] && missing_[head(row)] == 0;
    }
    bool comes_before(std::size_t a, std::size_t b) const {
        const double start_a = plan_.placements[head(a)].start;
        const double start_b = plan_.placements[head(b)].start;
        return start_a != start_b ? start_a < start_b : head(a) < head(b);
    }

    const scheduler::Plan& plan_;
    std::vector<int> missing_;                  ///< [task] that must come before
    std::vector<std::vector<int>> successors_;  ///< [task]
    std::vector<std::uint32_t> next_;           ///< [device] in the plan's order
};

}  // namespace

std::vector<int> submission_order(const Step& step, const scheduler::Plan& plan) {
    Walk walk(step, plan);
    std::vector<int> order;
    for (std::size_t i = 0; i < plan.order.size(); ++i) order.push_back(walk.take());
    if (!order.empty() && order.back() < 0) {
        throw Misuse("the plan's order cannot be followed: a task stands before one that it needs");
    }
    return order;
}

}  // namespace weft
