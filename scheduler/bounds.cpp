#include "scheduler/bounds.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace weft::scheduler {
namespace {

constexpr int kMaxSteps = 200;  // of the simplex method
// Relative, between the primal and the dual value. Large graphs need too many steps to the last
// digit.
constexpr double kTolerance = 1e-9, kToleranceLarge = 1e-4;
constexpr TaskId kLarge = 200;  // tasks
constexpr double kPivotTolerance = 1e-12;

}  // namespace

void LowerBounds::apply(const TaskGraph& graph, Plan& plan) {
    plan.path_bound = path(graph);
    plan.area_bound = area(graph);
    if (plan.meets_bound()) plan.proven_optimal = true;
}

double LowerBounds::path(const TaskGraph& graph) {
    const ProcessorId processors = graph.processor_count();
    find_heads(graph);
    tail_.resize(head_.size());
    double bound = 0.0;
    const std::span<const TaskId> forwards = graph.topological_order();
    for (auto each = forwards.rbegin(); each != forwards.rend(); ++each) {
        const TaskId t = *each;
        double least = kCannotRun;
        for (ProcessorId p = 0; p < processors; ++p) {
            const std::size_t at = std::size_t{t} * processors + p;
            double after = 0.0;
            for (const Arc& arc : graph.successors(t)) {
                const double* next = tail_.data() + std::size_t{arc.task} * processors;
                double shortest = kCannotRun;
                for (ProcessorId q = 0; q < processors; ++q) {
                    shortest = std::min(shortest, graph.transfer_time(arc, p, q) + next[q]);
                }
                after = std::max(after, shortest);
            }
            tail_[at] = graph.cost(t, p) + after;
            least = std::min(least, head_[at] + after);
        }
        bound = std::max(bound, least);
    }
    return bound;
}

void LowerBounds::find_heads(const TaskGraph& graph) {
    const ProcessorId processors = graph.processor_count();
    head_.resize(std::size_t{graph.task_count()} * processors);
    for (const TaskId t : graph.topological_order()) {
        for (ProcessorId p = 0; p < processors; ++p) {
            double ready = 0.0;
            for (const Arc& arc : graph.predecessors(t)) {
                const double* before = head_.data() + std::size_t{arc.task} * processors;
                double earliest = kCannotRun;
                for (ProcessorId q = 0; q < processors; ++q) {
                    earliest = std::min(earliest, before[q] + graph.transfer_time(arc, q, p));
                }
                ready = std::max(ready, earliest);
            }
            head_[std::size_t{t} * processors + p] = ready + graph.cost(t, p);
        }
    }
}

// The area bound is the value of a game: the planner picks a distribution over assignments of all
// tasks (each a vector of loads), the adversary picks weights of processors. As a linear program,
//     min T  with  T - sum_k x_k load_k[p] - slack_p = 0 for every p,
//                  sum_k x_k = 1,  x >= 0,  slack >= 0.
// Its assignments are far too many to list, but the one that helps most under the present dual
// weights is found by giving every task to the processor where its weighted cost is least.
// The basis has processors + 1 columns; T is always the basic variable of row 0.

double LowerBounds::area(const TaskGraph& graph) {
    const std::size_t processors = graph.processor_count();
    const double scale = start_basis(graph);
    if (scale == 0.0) return 0.0;
    double best = 0.0;
    const double tolerance = graph.task_count() > kLarge ? kToleranceLarge : kTolerance;
    for (int step = 0; step < kMaxSteps; ++step) {
        read_duals(processors);
        const auto lowest = std::min_element(weights_.begin(), weights_.end());
        column_.assign(processors + 1, 0.0);
        if (*lowest < -kPivotTolerance) {
            column_[static_cast<std::size_t>(lowest - weights_.begin())] = -1.0;  // a slack
        } else {
            for (double& w : weights_) w = std::max(w, 0.0);
            const double value = cheapest_load(graph, weights_) / scale;
            if (value > best) {
                best = value;
                best_weights_.assign(weights_.begin(), weights_.end());
            }
            const double primal = value_[0];
            if (primal - best <= tolerance * primal) break;
            for (std::size_t p = 0; p < processors; ++p) column_[p] = -load_[p] / scale;
            column_[processors] = 1.0;
        }
        if (!bring_in_column(processors)) break;
    }
    // Weighted sums of n costs carry a relative rounding error of up to n + P units.
    const double rounding = static_cast<double>(graph.task_count() + processors) *
                            std::numeric_limits<double>::epsilon();
    const double weight_sum = std::accumulate(best_weights_.begin(), best_weights_.end(), 0.0);
    return best * scale / weight_sum * (1.0 - rounding);
}

double LowerBounds::cheapest_load(const TaskGraph& graph, std::span<const double> weights) {
    const ProcessorId processors = graph.processor_count();
    load_.assign(processors, 0.0);
    for (TaskId t = 0; t < graph.task_count(); ++t) {
        const std::span<const double> cost = graph.costs(t);
        double least = kCannotRun;
        ProcessorId at = 0;
        // Without branches, since nobody can foretell them. Where the task cannot run, the product
        // is infinite, or no number if the weight is 0; neither is less.
        for (ProcessorId p = 0; p < processors; ++p) {
            const double weighted = weights[p] * cost[p];
            at = weighted < least ? p : at;
            least = weighted < least ? weighted : least;
        }
        load_[at] += cost[at];
    }
    double value = 0.0;
    for (ProcessorId p = 0; p < processors; ++p) value += weights[p] * load_[p];
    return value;
}

// Basis: T, the assignment for equal weights, and the slacks of all processors but the busiest.
// Returns the busiest one's load: the unit in which the program is solved, so that its tolerances
// hold for costs in any unit.
double LowerBounds::start_basis(const TaskGraph& graph) {
    const std::size_t processors = graph.processor_count();
    const std::size_t rows = processors + 1;
    weights_.assign(processors, 1.0 / static_cast<double>(processors));
    cheapest_load(graph, weights_);
    const auto busiest =
        static_cast<std::size_t>(std::max_element(load_.begin(), load_.end()) - load_.begin());
    const double scale = load_[busiest];
    if (scale == 0.0) {
        best_weights_ = weights_;
        return 0.0;
    }
    // Inverse in closed form: row 0 gives T = load of the busiest; then the assignment's share,
    // which is 1; then slack_p = load_busiest - load_p.
    inverse_.assign(rows * rows, 0.0);
    value_.assign(rows, 0.0);
    const auto at = [&](std::size_t row, std::size_t column) -> double& {
        return inverse_[row * rows + column];
    };
    at(0, busiest) = 1.0;
    at(0, processors) = 1.0;
    at(1, processors) = 1.0;
    std::size_t row = 2;
    for (std::size_t p = 0; p < processors; ++p) {
        if (p == busiest) continue;
        at(row, p) = -1.0;
        at(row, busiest) = 1.0;
        at(row, processors) = (scale - load_[p]) / scale;
        ++row;
    }
    for (std::size_t r = 0; r < rows; ++r) value_[r] = at(r, processors);
    return scale;
}

// Only T has a cost, so the duals are the first row of the inverse.
void LowerBounds::read_duals(std::size_t processors) {
    weights_.assign(inverse_.begin(), inverse_.begin() + static_cast<std::ptrdiff_t>(processors));
}

// Pivots column_ into the basis. False if no row limits it, which only rounding can bring about.
bool LowerBounds::bring_in_column(std::size_t processors) {
    const std::size_t rows = processors + 1;
    direction_.assign(rows, 0.0);
    for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < rows; ++c) direction_[r] += inverse_[r * rows + c] * column_[c];
    }
    std::size_t leaving = 0;  // T stays
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 1; r < rows; ++r) {
        if (direction_[r] <= kPivotTolerance) continue;
        const double ratio = std::max(value_[r], 0.0) / direction_[r];
        if (ratio < least) {
            least = ratio;
            leaving = r;
        }
    }
    if (leaving == 0) return false;
    double* pivot = inverse_.data() + leaving * rows;
    for (std::size_t c = 0; c < rows; ++c) pivot[c] /= direction_[leaving];
    value_[leaving] = least;
    for (std::size_t r = 0; r < rows; ++r) {
        if (r == leaving) continue;
        for (std::size_t c = 0; c < rows; ++c) inverse_[r * rows + c] -= direction_[r] * pivot[c];
        value_[r] -= direction_[r] * least;
    }
    return true;
}

}  // namespace weft::scheduler
