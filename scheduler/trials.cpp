#include "scheduler/trials.h"

#include <algorithm>
#include <cmath>

#include "scheduler/order_statistics.h"

namespace weft::scheduler {

namespace {
/// Frames that a trial takes at least: one to wake up, and one that says whether to go on.
constexpr double kShortest = 2.0;
}  // namespace

std::optional<std::uint32_t> Trials::next(std::uint32_t chosen, std::span<const double> expected,
                                          std::span<const double> hoped) {
    if (running_ && (alternative_ == chosen || !std::isfinite(expected[alternative_]))) {
        running_ = false;  // nothing is left to find out
    }
    for (auto a = static_cast<std::uint32_t>(expected.size()); a-- > 0 && !running_;) {
        if (a == chosen || !std::isfinite(expected[a])) continue;
        const double price = kShortest * std::max(0.0, hoped[a] - expected[chosen]);
        const bool promises = hoped[a] < (1.0 - settings_.promise) * expected[chosen];
        if (probes_.due(a, price, promises)) begin(a);
    }
    return running_ ? std::optional(alternative_) : std::nullopt;
}

void Trials::begin(std::uint32_t alternative) {
    running_ = true;
    alternative_ = alternative;
    frame_ = 0;
    charge_ = 0.0;
    ratios_.clear();
}

/// The middle of all frames that tell cannot be a gain any more once more than half were none.
bool Trials::is_lost() const {
    const auto is_none = [&](double ratio) { return !is_gain(ratio); };
    return std::ranges::count_if(ratios_, is_none) > (settings_.frames - settings_.waking) / 2;
}

bool Trials::is_over(double ratio) const {
    return frame_ >= settings_.frames || is_lost() ||
           (!ratios_.empty() && ratio > settings_.hopeless);
}

std::optional<std::uint32_t> Trials::end_frame(double seconds, double to_beat) {
    probes_.end_frame(seconds);
    if (!running_) return std::nullopt;
    charge_ += seconds - to_beat;
    if (!waking()) ratios_.push_back(seconds / to_beat);
    ++frame_;
    if (!is_over(seconds / to_beat)) return std::nullopt;
    running_ = false;
    probes_.paid(alternative_, std::max(0.0, charge_));
    return is_gain(middle_of(ratios_)) ? std::optional(alternative_) : std::nullopt;
}

void Trials::give_up(double seconds) {
    if (!running_) return;
    running_ = false;
    probes_.mistaken(alternative_, std::max(0.0, charge_ + seconds));
}

}  // namespace weft::scheduler
