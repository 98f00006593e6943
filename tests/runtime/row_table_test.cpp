#include "runtime/row_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/error.h"

namespace weft::test {
namespace {

/// Strips of 3, 0, 20 and 8 items.
class RowTables : public testing::Test {
protected:
    RowTables() {
        const int begins[] = {0, 3, 3, 23, 31};
        std::copy(std::begin(begins), std::end(begins), begin_.data());
    }
    /// Where every entry of every row is; each has to be a place of its own within its strip.
    std::set<int> places(RowTable& table, const std::vector<int>& room) {
        std::set<int> all;
        for (int strip = 0; strip < items_.strip_count; ++strip) {
            for (int item = items_.item(strip); item < items_.item(strip + 1); ++item) {
                const auto i = static_cast<std::size_t>(item);
                const int own = table.rows()[i + 31];
                EXPECT_EQ(own, room[static_cast<std::size_t>(strip)]);
                for (int k = 0; k < own; ++k) {
                    const int place = table.rows()[i] + RowTable::kStride * k;
                    EXPECT_TRUE(all.insert(place).second) << "item " << item << ", entry " << k;
                    EXPECT_GE(place, table.entries().item(strip));
                    EXPECT_LT(place, table.entries().item(strip + 1));
                }
            }
        }
        return all;
    }

    Buffer<int> begin_{"begin", 5};
    Segments items_{&begin_, 0, 1, 4};
};

TEST_F(RowTables, EveryEntryHasAPlaceOfItsOwn) {
    RowTable table("table", items_, 5);
    const auto& column = table.add_column<int>("others");
    const auto all = places(table, {5, 5, 5, 5});
    EXPECT_EQ(all.size(), 31U * 5U);
    EXPECT_LT(*all.rbegin(), static_cast<int>(column.count()));
}

/// The items of a slice stand beside each other, so that a pack of lanes reads one stretch.
TEST_F(RowTables, PacksAreContiguous) {
    RowTable table("table", items_, 3);
    for (const auto& [first, end] : {std::pair{0, 3}, {3, 11}, {11, 19}, {19, 23}, {23, 31}}) {
        for (int item = first; item < end; ++item) {
            EXPECT_EQ(table.rows()[static_cast<std::size_t>(item)],
                      table.rows()[static_cast<std::size_t>(first)] + item - first);
        }
    }
}

TEST_F(RowTables, StripsThatWereTooSmallGrowAndTheirNeighbours) {
    RowTable table("table", items_, 2, 0);
    const auto& column = table.add_column<float>("distances");
    std::fill(table.needs().data(), table.needs().data() + 31, 1);
    EXPECT_FALSE(table.overflowed());
    EXPECT_FALSE(table.is_tight());
    table.needs()[10] = 5;
    table.needs()[12] = 9;
    EXPECT_TRUE(table.overflowed());
    table.grow();
    EXPECT_FALSE(table.overflowed());
    EXPECT_FALSE(table.is_tight());
    EXPECT_EQ(table.generation(), 1);
    EXPECT_EQ(column.generation(), 1);
    const auto all = places(table, {6, 13, 13, 13});
    EXPECT_LT(*all.rbegin(), static_cast<int>(column.count()));
}

TEST_F(RowTables, ForgottenEntriesAreZerosAgain) {
    RowTable table("table", items_, 2);
    auto& column = table.add_column<float>("distances");
    const std::size_t count = column.count();
    std::ranges::fill(column.span(), 7.0f);
    table.forget();
    EXPECT_EQ(column.count(), count);
    EXPECT_EQ(column.generation(), 1);
    EXPECT_EQ(std::ranges::count(column.span(), 0.0f), static_cast<long>(count));
    places(table, {2, 2, 2, 2});
}

/// Whatever was wanted: growing anew in each frame would cost more than it saves.
TEST_F(RowTables, GrowsOnceForWhatIsWanted) {
    for (int wanted = 1; wanted < 40; ++wanted) {
        RowTable table("table", items_, wanted);
        table.needs()[10] = wanted;
        EXPECT_FALSE(table.overflowed()) << wanted;
        EXPECT_TRUE(table.is_tight()) << wanted;
        table.grow();
        EXPECT_FALSE(table.is_tight()) << wanted;
    }
}

/// What a table is filled from had no room for all: what that hid is reckoned with.
TEST_F(RowTables, GrowsForWhatItCouldNotSee) {
    RowTable first("first", items_, 4, 0);
    std::fill(first.needs().data(), first.needs().data() + 31, 4);
    first.needs()[10] = 12;
    EXPECT_EQ(first.shortages(), (std::vector<float>{1.0f, 1.0f, 3.0f, 1.0f}));
    RowTable second("second", items_, 8, 0);
    std::fill(second.needs().data(), second.needs().data() + 31, 5);
    EXPECT_FALSE(second.is_tight());
    EXPECT_TRUE(second.is_tight(first.shortages()));
    second.grow(first.shortages());
    places(second, {11, 22, 22, 22});
}

/// Rows of few entries get longer by more than a part of them, soon.
TEST_F(RowTables, ShortRowsGrowBySeveralEntries) {
    RowTable table("table", items_, 1, 0);
    std::fill(table.needs().data(), table.needs().data() + 31, 2);
    table.grow();
    places(table, {6, 6, 6, 6});
}

/// One crowded strip must not cost all others its memory.
TEST_F(RowTables, FarFromLongRowsRoomIsBounded) {
    RowTable table("table", items_, 2, 0);
    table.needs()[30] = 100;
    table.grow();
    places(table, {16, 16, 150, 150});
}

/// In a small table it costs little: all rows get as long.
TEST_F(RowTables, FarFromLongRowsThereIsAsMuchRoomAsIsPlenty) {
    RowTable table("table", items_, 2);
    table.add_column<int>("others");
    table.needs()[30] = 100;
    table.grow();
    places(table, {150, 150, 150, 150});
    RowTable larger("table", items_, 2, 31 * 5 * 40);
    larger.add_column<int>("others");
    larger.needs()[30] = 100;
    larger.grow();
    places(larger, {40, 40, 150, 150});
}

/// A row without room has a start that may be read.
TEST_F(RowTables, WithoutRoomThereIsAnEntryYet) {
    RowTable table("table", items_, 0);
    const auto& column = table.add_column<int>("others");
    for (std::size_t i = 0; i < 31; ++i) {
        EXPECT_LT(table.rows()[i], static_cast<int>(column.count()));
    }
}

TEST_F(RowTables, BeyondWhatCanBeAddressedIsAnError) {
    RowTable table("table", items_, 1);
    table.needs()[30] = 2'000'000'000 / 3;
    EXPECT_THROW(table.grow(), RunError);
}

}  // namespace
}  // namespace weft::test
