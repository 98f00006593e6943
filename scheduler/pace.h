#pragma once

#include <algorithm>
#include <cmath>

namespace weft::scheduler {

/// How much longer than expected everything takes at the moment. Machines have spells of some
/// frames in which all of them is faster or slower (clocks, other tenants); costs and corrections
/// are made to outlast these, but what the next frame takes is best told by the last one.
class Pace {
public:
    /// A change by more than this factor is a disturbance of one frame until the next one confirms
    /// it.
    static constexpr double kJump = 1.5;

    /// Notes what a frame took, and what it is expected to take by what is known now. Times that
    /// are no positive numbers are ignored.
    void frame(double expected, double seconds) {
        const double ratio = seconds / expected;
        if (!(ratio > 0.0) || !std::isfinite(ratio)) return;
        const bool jump = std::abs(std::log(ratio / last_)) > std::log(kJump);
        const bool last_is_nearer = std::abs(std::log(last_)) < std::abs(std::log(ratio));
        pace_ = jump && last_is_nearer ? last_ : ratio;
        last_ = ratio;
    }

    double operator()() const { return pace_; }

private:
    double pace_ = 1.0;
    double last_ = 1.0;  ///< of the last frame, believed or not
};

}  // namespace weft::scheduler
