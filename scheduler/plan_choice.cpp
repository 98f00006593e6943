#include "scheduler/plan_choice.h"

#include <algorithm>
#include <cmath>

#include "scheduler/order_statistics.h"

namespace weft::scheduler {

PlanChoice::PlanChoice(std::uint32_t alternatives, const PlanChoiceSettings& settings)
    : settings_(settings), history_(alternatives) {
    for (std::uint32_t i = 0; i < alternatives; ++i) forget(i);
}

/// Two frames as planned stand at the beginning, so that the first one measured is not the rule.
void PlanChoice::forget(std::uint32_t alternative) { history_[alternative] = {{1.0, 1.0}, 1.0}; }

std::uint32_t PlanChoice::choose(std::span<const double> predicted) {
    const auto expected = [&](std::uint32_t i) { return predicted[i] * correction(i); };
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
    for (std::uint32_t i = 0; i < history_.size(); ++i) {
        if (i == current_) continue;
        for (double& ratio : history_[i].ratios) ratio += settings_.forgetting_rate * (1.0 - ratio);
        update_median(history_[i]);
    }
    return current_;
}

void PlanChoice::measured(std::uint32_t alternative, double planned, double seconds) {
    if (!(planned > 0.0) || !(seconds > 0.0)) return;
    History& history = history_[alternative];
    if (history.ratios.size() >= settings_.window) history.ratios.erase(history.ratios.begin());
    history.ratios.push_back(seconds / planned);
    update_median(history);
}

void PlanChoice::given_up(std::uint32_t alternative, double planned, double seconds) {
    if (planned > 0.0) history_[alternative] = {{seconds / planned}, seconds / planned};
}

void PlanChoice::update_median(History& history) {
    sorted_ = history.ratios;
    history.median = middle_of(sorted_);
}

}  // namespace weft::scheduler
