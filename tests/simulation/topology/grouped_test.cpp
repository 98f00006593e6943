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

TEST(Grouped, MayHaveNoGroups) {
    EXPECT_EQ(Grouped<int>().count(), 0);
    EXPECT_EQ(Grouped<int>(0, [](const auto&) {}).count(), 0);
}

}  // namespace
}  // namespace weft
