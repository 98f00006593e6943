#include "scheduler/cost_drift.h"

#include <algorithm>

namespace weft::scheduler {

namespace {
/// Beyond, one of the two fits says nothing of so many items.
constexpr double kMostDrift = 100.0;
}  // namespace

CostDrift::CostDrift(std::uint32_t kinds, std::uint32_t devices)
    : kinds_(kinds), devices_(devices), then_(std::size_t{kinds} * devices * devices) {}

void CostDrift::note(const CostModel& costs) {
    for (std::uint32_t kind = 0; kind < kinds_; ++kind) {
        for (std::uint32_t device = 0; device < devices_; ++device) {
            if (costs.frames_unobserved(kind, device) > 1) continue;
            for (std::uint32_t other = 0; other < devices_; ++other) {
                then_[index(kind, device, other)] = costs.fit(kind, other).cost;
            }
        }
    }
}

double CostDrift::factor(const CostModel& costs, std::uint32_t kind, std::uint32_t device,
                         double items) const {
    std::uint32_t latest = device;
    for (std::uint32_t other = 0; other < devices_; ++other) {
        if (costs.frames_unobserved(kind, other) < costs.frames_unobserved(kind, latest)) {
            latest = other;
        }
    }
    if (latest == device) return 1.0;
    const double then = then_[index(kind, device, latest)](items);
    const double now = costs.predict(kind, latest, items);
    if (!(then > 0.0 && now > 0.0)) return 1.0;
    return std::clamp(now / then, 1.0 / kMostDrift, kMostDrift);
}

}  // namespace weft::scheduler
