#include "apps/weft/studies/repeated_time.h"

#include <algorithm>
#include <cmath>

#include "scheduler/order_statistics.h"

namespace weft {

namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kMost = 25;
/// Of the median's standard error, relative to it.
constexpr double kSettled = 0.02;

}  // namespace

void RepeatedTime::add(double seconds) {
    times_.push_back(seconds);
    total_ += seconds;
}

double RepeatedTime::median() const {
    std::vector<double> times = times_;
    return scheduler::middle_of(times);
}

/// The standard error is that of normal noise, 1.253 sigma / sqrt(n), with sigma = 1.4826 times the
/// median distance from the median: outliers do not count.
bool RepeatedTime::is_settled() const {
    if (times_.size() < kFewest) return false;
    if (times_.size() >= kMost || total_ > budget_) return true;
    const double middle = median();
    std::vector<double> distances;
    for (const double time : times_) distances.push_back(std::abs(time - middle));
    const double error = 1.253 * 1.4826 * scheduler::middle_of(distances) /
                         std::sqrt(static_cast<double>(times_.size()));
    return error <= kSettled * middle;
}

}  // namespace weft
