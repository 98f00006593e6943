#include "runtime/lane_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace weft {
namespace {

std::vector<double> numbers(int count) {
    std::vector<double> list;
    for (int i = 0; i < count; ++i) list.push_back(1.0 + (i * 37) % 101);
    return list;
}

TEST(InLanes, AddsEveryTermOnce) {
    for (int count = 0; count < 40; ++count) {
        const auto terms = numbers(count);
        LaneSum sum;
        sum.add(terms);
        EXPECT_EQ(sum.total(), std::accumulate(terms.begin(), terms.end(), 0.0)) << count;
    }
}

TEST(InLanes, GoesOnFromPartToPart) {
    const auto terms = numbers(100);
    LaneSum sum;
    LaneMaximum largest;
    for (const std::size_t begin : {0, 24, 96}) {
        const std::size_t end = begin == 0 ? 24 : begin == 24 ? 96 : 100;
        const std::span part = std::span(terms).subspan(begin, end - begin);
        sum.add(part);
        largest.add(part);
    }
    EXPECT_EQ(sum.total(), std::accumulate(terms.begin(), terms.end(), 0.0));
    EXPECT_EQ(largest.total(), *std::ranges::max_element(terms));
}

TEST(InLanes, OfNothingIsZero) {
    EXPECT_EQ(LaneSum().total(), 0.0);
    EXPECT_EQ(LaneMaximum().total(), 0.0);
}

}  // namespace
}  // namespace weft
