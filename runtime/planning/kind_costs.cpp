#include "runtime/planning/kind_costs.h"

#include <algorithm>
#include <limits>

namespace weft {

namespace {

/// Devices are alike if one is no more than so many times as good at one kind as at another.
constexpr double kAlike = 1.5;
/// A kind that takes less of the time than this has no say in that.
constexpr double kLeastShare = 0.05;

}  // namespace

KindCosts::KindCosts(std::vector<int> devices, std::size_t device_count)
    : devices_(std::move(devices)), device_count_(device_count) {}

void KindCosts::sum_up(const Step& step, const TimingModel& timing) {
    cost_.assign(timing.costs().kinds() * device_count_, 0.0);
    for (const Task& task : step.tasks()) {
        double* costs = cost_.data() + static_cast<std::size_t>(task.body->kind) * device_count_;
        for (const int d : devices_) costs[d] += timing.task(task, d);
    }
}

double KindCosts::least_time() {
    kinds_.clear(static_cast<scheduler::ProcessorId>(device_count_));
    std::vector<double> costs(device_count_, scheduler::kCannotRun);
    for (std::size_t k = 0; k < kind_count(); ++k) {
        for (const int d : devices_) costs[static_cast<std::size_t>(d)] = cost(k, d);
        kinds_.add_task(costs);
    }
    kinds_.seal();
    return bounds_.area(kinds_);
}

bool KindCosts::differ(int a, int b) const {
    double all = 0.0;
    for (std::size_t k = 0; k < kind_count(); ++k) all += cost(k, a);
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
    for (std::size_t k = 0; k < kind_count(); ++k) {
        if (cost(k, a) < kLeastShare * all || !(cost(k, b) > 0.0)) continue;
        least = std::min(least, cost(k, a) / cost(k, b));
        most = std::max(most, cost(k, a) / cost(k, b));
    }
    return most > kAlike * least;
}

bool KindCosts::differ() const {
    return std::ranges::any_of(devices_, [&](int a) {
        return std::ranges::any_of(devices_, [&](int b) { return differ(a, b); });
    });
}

struct KindCosts::Shares {
    int strip_count;
    std::vector<Division> of_kind;
    std::vector<double> load;  ///< [device]
};

/// The best way to give so many strips of a kind from the busiest device to another one, if that
/// makes the busiest one less busy.
bool KindCosts::hand_over(Shares& shares, int strips) const {
    const double part = static_cast<double>(strips) / shares.strip_count;
    const auto from = static_cast<int>(std::ranges::max_element(shares.load) - shares.load.begin());
    const auto busiest = static_cast<std::size_t>(from);
    double least = shares.load[busiest];
    std::size_t best_kind = kind_count();
    std::size_t best_device = 0;
    for (std::size_t k = 0; k < kind_count(); ++k) {
        if (shares.of_kind[k].strips[busiest] < strips) continue;
        for (const int d : devices_) {
            const auto to = static_cast<std::size_t>(d);
            const double left = shares.load[busiest] - part * cost(k, from);
            const double most = std::max(left, shares.load[to] + part * cost(k, d));
            if (d == from || most >= least) continue;
            least = most;
            best_kind = k;
            best_device = to;
        }
    }
    if (best_kind == kind_count()) return false;
    shares.of_kind[best_kind].strips[busiest] -= strips;
    shares.of_kind[best_kind].strips[best_device] += strips;
    shares.load[busiest] -= part * cost(best_kind, from);
    shares.load[best_device] += part * cost(best_kind, static_cast<int>(best_device));
    return true;
}

std::vector<Division> KindCosts::balance(int strip_count) const {
    Shares shares{strip_count, {}, std::vector<double>(device_count_, 0.0)};
    for (std::size_t k = 0; k < kind_count(); ++k) {
        const int best = *std::ranges::min_element(devices_, {}, [&](int d) { return cost(k, d); });
        shares.of_kind.push_back(
            Division::single(static_cast<int>(device_count_), strip_count, best));
        shares.load[static_cast<std::size_t>(best)] += cost(k, best);
    }
    for (int strips = strip_count; strips > 0; strips /= 2) {
        while (hand_over(shares, strips)) {
        }
    }
    return std::move(shares.of_kind);
}

}  // namespace weft
