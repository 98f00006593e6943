#include "runtime/split.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

using Parts = std::vector<std::string>;

TEST(Split, GivesOnePartMoreThanThereAreMarks) {
    EXPECT_EQ(split("a+bc+d", '+'), (Parts{"a", "bc", "d"}));
    EXPECT_EQ(split("a", '+'), Parts{"a"});
}

TEST(Split, KeepsPartsThatAreEmpty) {
    EXPECT_EQ(split("", '+'), Parts{""});
    EXPECT_EQ(split("+a++", '+'), (Parts{"", "a", "", ""}));
}

}  // namespace
}  // namespace weft
