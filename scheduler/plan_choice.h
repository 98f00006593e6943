#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft::scheduler {

struct PlanChoiceSettings {
    double margin = 0.03;           ///< relative gain below which a change is not worth it
    std::uint32_t patience = 3;     ///< frames in a row in which the gain must be there
    std::uint32_t window = 9;       ///< frames in use that a correction is the median of
    double forgetting_rate = 0.01;  ///< of corrections, per frame out of use
};

/// Chooses between alternatives (each single device, the mixture, ...) frame by frame, so that
/// noise does not flip plans: a change needs a gain above the margin for some frames in a row. And
/// what predictions get wrong is learnt: each alternative's prediction is multiplied by how much
/// longer than planned it has been taking (the median of its last frames), which is slowly
/// forgotten while it is out of use, or one bad spell would rule it out for good.
class PlanChoice {
public:
    explicit PlanChoice(std::uint32_t alternatives, const PlanChoiceSettings& settings = {});

    /// predicted  [alternative] seconds; infinite where it is impossible. At least one is finite.
    /// Changes at once if the present one has become impossible.
    std::uint32_t choose(std::span<const double> predicted);

    /// What a frame planned by this alternative took.
    void measured(std::uint32_t alternative, double planned, double seconds);

    /// One that took so much longer than planned that it was given up: nothing else is known of it.
    void given_up(std::uint32_t alternative, double planned, double seconds);

    std::uint32_t current() const { return current_; }
    /// Changes at once: it has been seen to be faster.
    void prefer(std::uint32_t alternative) {
        current_ = alternative;
        frames_better_ = 0;
    }
    /// Begins anew with what is learnt of an alternative.
    void forget(std::uint32_t alternative);
    /// How much longer than planned the alternative takes, as learnt.
    double correction(std::uint32_t alternative) const { return history_[alternative].median; }

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// measured / planned of the last frames in use.
    struct History {
        std::vector<double> ratios;
        double median = 1.0;
    };
    void update_median(History& history);

    PlanChoiceSettings settings_;
    std::vector<History> history_;  // [alternative]
    std::vector<double> sorted_;    // working memory
    std::uint32_t current_ = kNone;
    std::uint32_t frames_better_ = 0;
};

}  // namespace weft::scheduler
