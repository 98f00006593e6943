#include "scheduler/cost_drift.h"

namespace weft::scheduler {

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

double CostDrift::predict(const CostModel& costs, std::uint32_t kind, std::uint32_t device,
                          double items) const {
    std::uint32_t latest = device;
    for (std::uint32_t other = 0; other < devices_; ++other) {
        if (costs.frames_unobserved(kind, other) < costs.frames_unobserved(kind, latest)) {
            latest = other;
        }
    }
    const double own = costs.predict(kind, device, items);
    if (latest == device) return own;
    // Fits that stand on other numbers of items may say anything of these.
    const double seen = costs.last_items(kind, device);
    const double theirs = then_[index(kind, device, latest)](seen);
    const double now = costs.predict(kind, latest, items);
    if (!(seen > 0.0 && theirs > 0.0 && now > 0.0)) return own;
    return costs.predict(kind, device, seen) / theirs * now;
}

}  // namespace weft::scheduler
