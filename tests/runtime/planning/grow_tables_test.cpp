// Tables that are filled one from the other grow together, so that a frame runs again only once.

#include <gtest/gtest.h>

#include "runtime/executor.h"
#include "runtime/planning/planned_executor.h"
#include "runtime/tbb/cpu_device.h"

namespace weft::test {
namespace {

/// Two strips of 8 items.
class GrowTables : public testing::Test {
protected:
    GrowTables() {
        const int begins[] = {0, 8, 16};
        std::ranges::copy(begins, begin_.data());
        for (RowTable* table : tables()) {
            std::fill(table->needs().data(), table->needs().data() + 16, 5);
        }
    }
    std::vector<RowTable*> tables() { return {&near_, &pairs_, &rows_}; }
    bool grow() { return grow_tables(tables(), executor_); }

    Buffer<int> begin_{"begin", 3};
    Segments items_{&begin_, 0, 1, 2};
    RowTable near_{"near", items_, 8, 0};
    RowTable pairs_{"pairs", items_, 8, 0};
    RowTable rows_{"rows", items_, 8, 0};
    std::unique_ptr<Device> cpu_ = make_cpu_device(1, {});
    Executor executor_{{cpu_.get()}, {}};
};

TEST_F(GrowTables, WhereNothingIsMissingTheyStay) {
    EXPECT_FALSE(grow());
    for (RowTable* table : tables()) EXPECT_EQ(table->generation(), 0);
}

TEST_F(GrowTables, ThoseBehindOneThatLackedRoomGetAsManyTimesWhatTheyWanted) {
    pairs_.needs()[3] = 16;
    EXPECT_TRUE(grow());
    EXPECT_EQ(near_.generation(), 0);
    EXPECT_EQ(pairs_.generation(), 1);
    EXPECT_EQ(rows_.generation(), 1);
    rows_.needs()[3] = 10;  // twice what it could see
    EXPECT_FALSE(rows_.is_tight());
    EXPECT_FALSE(grow());
}

TEST_F(GrowTables, ThoseThatHaveEnoughForThatStay) {
    std::fill(rows_.needs().data(), rows_.needs().data() + 16, 1);
    pairs_.needs()[3] = 16;
    EXPECT_TRUE(grow());
    EXPECT_EQ(rows_.generation(), 0);
}

}  // namespace
}  // namespace weft::test
