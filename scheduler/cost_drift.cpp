#include "scheduler/cost_drift.h"

namespace weft::scheduler {

namespace {
/// Frames in use behind which a fit says what is, and no longer what was before.
constexpr std::uint32_t kSettled = 4;
}  // namespace

CostDrift::CostDrift(std::uint32_t kinds, std::uint32_t devices)
    : kinds_(kinds),
      devices_(devices),
      then_(std::size_t{kinds} * devices * devices),
      seen_(std::size_t{kinds} * devices, 0) {}

/// Of another device that was out of use at the time, or had just begun, the first that is known
/// for sure behind it: until then, what it is seen to take is learnt, and has not changed.
void CostDrift::note(const CostModel& costs) {
    for (std::uint32_t kind = 0; kind < kinds_; ++kind) {
        std::uint32_t* const seen = &seen_[std::size_t{kind} * devices_];
        for (std::uint32_t device = 0; device < devices_; ++device) {
            seen[device] = costs.frames_unobserved(kind, device) > 1 ? 0 : seen[device] + 1;
        }
        for (std::uint32_t device = 0; device < devices_; ++device) {
            for (std::uint32_t other = 0; other < devices_; ++other) {
                LinearCost& then = then_[index(kind, device, other)];
                if (seen[device] > 0) then = {};
                if (then(1.0) == 0.0 && seen[other] >= kSettled) then = costs.fit(kind, other).cost;
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
