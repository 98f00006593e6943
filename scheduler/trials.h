#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scheduler/probing.h"

namespace weft::scheduler {

struct TrialSettings {
    std::uint32_t frames = 4;  ///< of a trial
    /// Of these, at the beginning, tell nothing: what was asleep wakes up.
    std::uint32_t waking = 1;
    /// A trial ends at the first frame behind these that takes so many times what it has to beat,
    /// and once it cannot end well any more.
    double hopeless = 1.5;
    /// Relative gain below which a change is not worth it.
    double margin = 0.03;
    /// Relative gain that is worth a trial before its time.
    double promise = 0.1;
};

/// Tries what the plans leave out, in earnest: a trial is several frames long, and judged by the
/// later ones. Threads that have slept, clocks that have gone down and caches that are cold make
/// the first frame slow, so who is tried for one frame only is never seen awake. When to try is
/// ProbePolicy's decision; a trial is charged with what it took longer.
class Trials {
public:
    explicit Trials(std::uint32_t alternatives, const ProbeSettings& probes = {},
                    const TrialSettings& settings = {})
        : settings_(settings), probes_(alternatives, probes) {}

    /// The alternative to try in the next frame, if any; of several that are due, the last one: a
    /// trial of many devices tells more than one of one. Call once per frame.
    /// chosen    what would be done otherwise
    /// expected  [alternative] seconds of a frame; infinite where there is nothing to try
    /// hoped     [alternative] the same where forecasts disagree: the shortest of them
    std::optional<std::uint32_t> next(std::uint32_t chosen, std::span<const double> expected,
                                      std::span<const double> hoped);
    std::optional<std::uint32_t> next(std::uint32_t chosen, std::span<const double> expected) {
        return next(chosen, expected, expected);
    }

    /// Whether the frame of the last next() belongs to a trial.
    bool running() const { return running_; }
    /// Whether it is one of those that tell nothing.
    bool waking() const { return running_ && frame_ < settings_.waking; }

    /// All that this alternative needs has been in use in this frame: it needs no trial.
    void used(std::uint32_t alternative) { probes_.used(alternative); }

    /// What is known of it is doubtful: it may be tried as soon as there is credit.
    void doubt(std::uint32_t alternative) { probes_.doubt(alternative); }

    /// Ends a frame. Gives the alternative whose trial has just ended well: its frames, but for the
    /// first, were faster, by the margin, than what the chosen one was expected to take.
    /// seconds, to_beat  that the frame took, and that the chosen alternative would have taken
    std::optional<std::uint32_t> end_frame(double seconds, double to_beat);

    /// A frame of a trial was given up in its middle, which ends the trial.
    /// seconds  that were lost by it
    void give_up(double seconds);

private:
    void begin(std::uint32_t alternative);
    bool is_gain(double ratio) const { return ratio < 1.0 - settings_.margin; }
    bool is_lost() const;
    bool is_over(double ratio) const;

    TrialSettings settings_;
    ProbePolicy probes_;
    bool running_ = false;
    std::uint32_t alternative_ = 0;
    std::uint32_t frame_ = 0;     ///< of the trial
    double charge_ = 0.0;         ///< seconds that it took longer so far
    std::vector<double> ratios_;  ///< of frames that tell: seconds / to_beat
};

}  // namespace weft::scheduler
