#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weft::scheduler {

struct ProbeSettings {
    std::uint32_t interval = 30;       ///< frames out of use after which a device may be probed
    std::uint32_t short_interval = 8;  ///< the same of one that promises a gain
    double price_share = 0.01;         ///< part of the run time that probes may cost
    double start_frames = 0.5;  ///< frames' time that first probes may be paid with in advance
};

/// When to try a device that the plans leave out, since its costs may have been learnt in a bad
/// moment. Probes are paid from a credit that grows with the run time: so their price is bounded,
/// however slow the device is, and yet each device is probed again in the end. What is known at the
/// start is from another time, so all devices are due then: a device's first probe may be paid from
/// an advance, which the credit has to make good before the next ones.
class ProbePolicy {
public:
    explicit ProbePolicy(std::uint32_t devices, const ProbeSettings& settings = {})
        : settings_(settings),
          idle_frames_(devices, settings.interval),
          probed_(devices, false),
          debts_(devices, 0.0) {}

    /// Call once per frame.
    /// seconds  what it took
    void end_frame(double seconds) {
        if (is_first_) advance_ = settings_.start_frames * seconds;
        is_first_ = false;
        credit_ += settings_.price_share * seconds;
        for (std::uint32_t& frames : idle_frames_) ++frames;
        for (double& debt : debts_) debt = std::max(0.0, debt - settings_.price_share * seconds);
    }
    /// The device has run tasks of this frame, so its costs are up to date.
    void used(std::uint32_t device) { idle_frames_[device] = 0; }

    /// What is known of the device is doubtful, however short it has been out of use.
    void doubt(std::uint32_t device) { idle_frames_[device] = settings_.interval; }

    /// Whether to probe the device now. What is known of it counts less and less as it grows old:
    /// down to a quarter.
    /// price     predicted seconds by which the frame gets longer; >= 0
    /// promises  that it gets shorter: then there is no need to wait as long, and in the end not
    ///           for credit either, which others may have overdrawn
    bool due(std::uint32_t device, double price, bool promises = false) const {
        const std::uint32_t least = promises ? settings_.short_interval : settings_.interval;
        if (idle_frames_[device] < least) return false;
        const double age = static_cast<double>(idle_frames_[device]) / settings_.interval;
        const double advance = probed_[device] ? 0.0 : advance_;
        if (promises && idle_frames_[device] >= settings_.interval) return debts_[device] == 0.0;
        return price / std::clamp(age, 1.0, 4.0) + debts_[device] <= credit_ + advance;
    }
    /// A probe was made.
    /// price  as predicted, or as measured [s]
    void paid(std::uint32_t device, double price) {
        credit_ -= price;
        probed_[device] = true;
        idle_frames_[device] = 0;
    }
    /// A probe was made that cost far more than anybody expected. Others do not wait for that, as
    /// they had no part in it; the device does, as if all credit were its own.
    void mistaken(std::uint32_t device, double price) {
        debts_[device] += price;
        paid(device, 0.0);
    }

private:
    ProbeSettings settings_;
    bool is_first_ = true;
    double credit_ = 0.0;  // [s] probes may cost; negative after one that was dearer than predicted
    double advance_ = 0.0;
    std::vector<std::uint32_t> idle_frames_;  // [device]
    std::vector<bool> probed_;                // [device]
    std::vector<double> debts_;               // [device] of mistakes
};

}  // namespace weft::scheduler
