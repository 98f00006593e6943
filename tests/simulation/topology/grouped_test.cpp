#include "simulation/topology/grouped.h"

#include <gtest/gtest.h>

#include <string>

namespace weft {
namespace {

TEST(Grouped, KeepsTheOrderWithinAGroup) {
    const Grouped<char> letters(4, [](const auto& put) {
        put(2, 'a');
        put(0, 'b');
        put(2, 'c');
        put(3, 'd');
        put(2, 'e');
    });
    ASSERT_EQ(letters.count(), 4);
    const auto text = [&](int group) {
        return std::string(letters[group].begin(), letters[group].end());
    };
    EXPECT_EQ(text(0), "b");
    EXPECT_EQ(text(1), "");
    EXPECT_EQ(text(2), "ace");
    EXPECT_EQ(text(3), "d");
}

TEST(Grouped, MayBeFilledInLater) {
    auto numbers = Grouped<int>::of_sizes(3, [](int group) { return 2 - group; });
    ASSERT_EQ(numbers.count(), 3);
    EXPECT_EQ(numbers[0].size(), 2U);
    EXPECT_EQ(numbers[1].size(), 1U);
    EXPECT_TRUE(numbers[2].empty());
    numbers[1][0] = 7;
    numbers[0][1] = 5;
    EXPECT_EQ(numbers.values()[1], 5);
    EXPECT_EQ(numbers.values()[2], 7);
}

TEST(Grouped, MayHaveNoGroups) {
    EXPECT_EQ(Grouped<int>().count(), 0);
    EXPECT_EQ(Grouped<int>(0, [](const auto&) {}).count(), 0);
    EXPECT_EQ(Grouped<int>::of_sizes(0, [](int) { return 1; }).count(), 0);
}

}  // namespace
}  // namespace weft
