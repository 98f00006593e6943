#include "scheduler/plan_choice.h"

#include <algorithm>
#include <cmath>

namespace weft::scheduler {
namespace {

// One frame counts as at most this much longer or shorter than expected, so that a disturbed one
// hardly moves the correction.
constexpr double kLargestStep = 1.25;

}  // namespace

PlanChoice::PlanChoice(std::uint32_t alternatives, const PlanChoiceSettings& settings)
    : settings_(settings), correction_(alternatives, 1.0) {}

std::uint32_t PlanChoice::choose(std::span<const double> predicted) {
    const auto expected = [&](std::uint32_t i) { return predicted[i] * correction_[i]; };
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < predicted.size(); ++i) {
        if (expected(i) < expected(best)) best = i;
    }
    const bool possible = current_ != kNone && std::isfinite(predicted[current_]);
    const bool better = possible && expected(best) < expected(current_) * (1.0 - settings_.margin);
    frames_better_ = better ? frames_better_ + 1 : 0;
    if (!possible || frames_better_ >= settings_.patience) {
        current_ = best;
        frames_better_ = 0;
    }
    for (std::uint32_t i = 0; i < correction_.size(); ++i) {
        if (i != current_) correction_[i] += settings_.forgetting_rate * (1.0 - correction_[i]);
    }
    return current_;
}

void PlanChoice::measured(std::uint32_t alternative, double planned, double seconds) {
    if (!(planned > 0.0) || !(seconds > 0.0)) return;
    double& correction = correction_[alternative];
    const double ratio =
        std::clamp(seconds / planned, correction / kLargestStep, correction * kLargestStep);
    correction += settings_.learning_rate * (ratio - correction);
}

}  // namespace weft::scheduler
