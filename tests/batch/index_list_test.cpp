#include "apps/weft/batch/index_list.h"

#include "sweep_text.h"

namespace weft::batch {
namespace {

using Indices = std::vector<std::size_t>;

TEST(IndexList, ReadsNumbersAndRanges) {
    EXPECT_EQ(parse_indices("7", 10, {}), (Indices{7}));
    EXPECT_EQ(parse_indices("0-3", 10, {}), (Indices{0, 1, 2, 3}));
    EXPECT_EQ(parse_indices("9,3,3-4", 10, {}), (Indices{3, 4, 9}));
    EXPECT_EQ(parse_indices("all", 3, {0, 2}), (Indices{0, 2}));
}

TEST(IndexList, RefusesWhatIsNoList) {
    for (const char* text : {"", "x", "1,", "-1", "3-1", "1-", "1.5", "10", "0-10", "1 2",
                             "99999999999999999999999"}) {
        EXPECT_THROW(parse_indices(text, 10, {}), UserError) << text;
    }
    EXPECT_NE(message_of([] { parse_indices("12", 10, {}); }).find("the last one is 9"),
              std::string::npos);
    EXPECT_THROW(parse_indices("all", 0, {}), UserError);
}

TEST(IndexList, RangesAreReadBack) {
    EXPECT_EQ(to_ranges({}), "");
    EXPECT_EQ(to_ranges({1, 3, 4, 5, 7, 8}), "1,3-5,7-8");
    EXPECT_EQ(to_python({1, 3, 4, 5, 7, 8}), "[1, *range(3, 6), *range(7, 9)]");
    // Every subset of ten numbers.
    for (unsigned set = 1; set < 1024; ++set) {
        Indices indices;
        for (unsigned i = 0; i < 10; ++i) {
            if ((set >> i & 1U) != 0) indices.push_back(i);
        }
        EXPECT_EQ(parse_indices(to_ranges(indices), 10, {}), indices);
    }
}

}  // namespace
}  // namespace weft::batch
