#include "runtime/near_miss.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(NearMiss, FindsMistypedWords) {
    const std::vector<std::string> words{"frames", "friction", "dt", "max_speed"};
    EXPECT_EQ(near_miss("framez", words), "did you mean 'frames'?");
    EXPECT_EQ(near_miss("farmes", words), "did you mean 'frames'?");
    EXPECT_EQ(near_miss("Max-Speed", words), "did you mean 'max_speed'?");
    EXPECT_EQ(near_miss("td", words), "did you mean 'dt'?");
    EXPECT_EQ(near_miss("colour", words), "");
    EXPECT_EQ(near_miss("", words), "");
    EXPECT_EQ(near_miss(std::string(100000, 'x'), words), "");
}

TEST(NearMiss, ListsTheWordsWhereNoneIsNear) {
    EXPECT_EQ(near_miss_or_list("zzz", {"a", "b"}), "known: a, b");
}

}  // namespace
}  // namespace weft
