#include "simulation/families/sliced_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace weft {
namespace {

/// Strips of items whose rows have these lengths.
const std::vector<int> kSegments{0, 3, 3, 5, 16};
const std::vector<int> kLengths{2, 0, 5, 1, 1, 4, 4, 4, 4, 4, 4, 4, 4, 7, 0, 1};

TEST(SlicedRows, EveryEntryHasAPlaceOfItsOwn) {
    for (const int stride : {1, 2, 4, SlicedRows::kStride}) {
        SlicedRows rows("rows", kSegments, kLengths, stride);
        std::set<std::size_t> places;
        for (int i = 0; i < rows.item_count(); ++i) {
            EXPECT_GE(rows.length(i), kLengths[static_cast<std::size_t>(i)]);
            EXPECT_GE(rows.room(i), rows.length(i));
            for (int k = 0; k < rows.room(i); ++k) {
                EXPECT_LT(rows.entry(i, k), static_cast<std::size_t>(rows.entry_count()));
                EXPECT_TRUE(places.insert(rows.entry(i, k)).second) << "item " << i;
            }
        }
    }
}

TEST(SlicedRows, ItemsOfASliceLieSideBySide) {
    for (const int stride : {2, 4, SlicedRows::kStride}) {
        SlicedRows rows("rows", kSegments, kLengths, stride);
        for (std::size_t s = 0; s + 1 < kSegments.size(); ++s) {
            for (int i = kSegments[s]; i + 1 < kSegments[s + 1]; ++i) {
                if ((i + 1 - kSegments[s]) % stride == 0) continue;
                EXPECT_EQ(rows.entry(i, 0) + 1, rows.entry(i + 1, 0)) << "item " << i;
                EXPECT_EQ(rows.room(i), rows.room(i + 1)) << "item " << i;
            }
        }
    }
}

/// What row_length() of kernels/descent/rows.h says of a pack.
int length_of_pack(const SlicedRows& rows, int first, int count) {
    return count <= 8 ? rows.length(first) : std::max(rows.length(first), rows.length(first + 8));
}

/// As long as the longest row of its own half, or of both: no longer, so that a narrow pack does
/// not wait for what is not in it.
TEST(SlicedRows, APackIsAsLongAsItsLongestRow) {
    const std::vector<int> segments{0, 19, 40};
    std::vector<int> lengths;
    for (int i = 0; i < 40; ++i) lengths.push_back(7 * i % 11);
    const SlicedRows rows("rows", segments, lengths);
    for (const int lanes : {1, 8, 16}) {
        for (std::size_t s = 0; s + 1 < segments.size(); ++s) {
            for (int first = segments[s]; first < segments[s + 1]; first += lanes) {
                const int end = std::min(first + lanes, segments[s + 1]);
                const int longest =
                    *std::max_element(lengths.begin() + first, lengths.begin() + end);
                const int length = length_of_pack(rows, first, end - first);
                if (lanes == 1)
                    EXPECT_GE(length, longest) << first;
                else
                    EXPECT_EQ(length, longest) << lanes << " lanes from item " << first;
                for (int i = first; i < end; ++i) EXPECT_LE(length, rows.room(i)) << i;
            }
        }
    }
}

TEST(SlicedRows, AStrideOfFewItemsLeavesNoRoomEmpty) {
    const std::vector<int> segments{0, 2, 4}, lengths{3, 3, 5, 5};
    EXPECT_EQ(SlicedRows("rows", segments, lengths, 2).entry_count(), 2 * 3 + 2 * 5);
    EXPECT_EQ(SlicedRows("rows", segments, lengths).entry_count(), 16 * 3 + 16 * 5);
}

}  // namespace
}  // namespace weft
