#pragma once

#include <chrono>
#include <optional>

namespace weft::batch {

/// When a process has to begin to stop, so that its last frame and checkpoint are done in time.
class Deadline {
public:
    /// time_limit  [s] from now; else what Slurm leaves (SLURM_JOB_END_TIME); else none
    explicit Deadline(std::optional<double> time_limit);

    std::optional<double> seconds_left() const;
    bool is_over() const;

private:
    using Clock = std::chrono::steady_clock;
    std::optional<Clock::time_point> end_;
};

/// How long before a time limit to stop: a twentieth of it, between 1 s and a minute, but never
/// more than half of it [s].
double stopping_margin(double time_limit);

}  // namespace weft::batch
