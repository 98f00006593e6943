#pragma once

#include <vector>

namespace weft {

/// A time that is measured again and again, as often as its noise needs: then its median counts.
class RepeatedTime {
public:
    /// budget: [s] that repeats may take once there are the fewest that make a median
    explicit RepeatedTime(double budget) : budget_(budget) {}

    void add(double seconds);
    /// Whether more repeats would hardly change the median, or are too dear.
    bool is_settled() const;
    double median() const;
    double total() const { return total_; }  ///< of all repeats [s]

private:
    double budget_;
    double total_ = 0.0;
    std::vector<double> times_;
};

}  // namespace weft
