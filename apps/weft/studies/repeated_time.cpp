#include "apps/weft/studies/repeated_time.h"

#include <algorithm>
#include <cmath>

namespace weft {

namespace {

constexpr std::size_t kFewest = 3;
constexpr std::size_t kMost = 25;
/// Of the median's standard error, relative to it.
constexpr double kSettled = 0.02;

double middle_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void RepeatedTime::add(double seconds) {
    times_.push_back(seconds);
    total_ += seconds;
}

double RepeatedTime::median() const { return middle_of(times_); }

/// The standard error is that of normal noise, 1.253 sigma / sqrt(n), with sigma = 1.4826 times the
/// median distance from the median: outliers do not count.
bool RepeatedTime::is_settled() const {
    if (times_.size() < kFewest) return false;
    if (times_.size() >= kMost || total_ > budget_) return true;
    const double middle = median();
    std::vector<double> distances;
    for (const double time : times_) distances.push_back(std::abs(time - middle));
    const double error = 1.253 * 1.4826 * middle_of(std::move(distances)) /
                         std::sqrt(static_cast<double>(times_.size()));
    return error <= kSettled * middle;
}

}  // namespace weft
