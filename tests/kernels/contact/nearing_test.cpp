#include "kernels/contact/nearing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"
#include "tests/kernels/run_on_host.h"

namespace weft::test {
namespace {

constexpr int kPatches = 4;
constexpr float kMargin = 1.0f;
constexpr float kSpare = 0.01f;
constexpr float kSlack = 0.5f;
constexpr int kNow = 5;

/// Cubes of edge 1 in a row along x, which patch 0 looks at. It has collected with a slack of 0.5.
class Nearing : public testing::Test {
protected:
    Nearing() {
        for (RowTable* table : {&near_, &kept_}) std::ranges::fill(table->counts().span(), 0);
        std::ranges::fill(slacks_.span(), kSlack);
        std::ranges::fill(stamps_.span(), kNow);
        epoch_[0] = kNow;
        for (int p = 0; p < kPatches; ++p) place(p, 10.0f * static_cast<float>(p));
    }

    void place(int patch, float x) {
        const auto p = static_cast<std::size_t>(patch);
        low_[p] = {x, 0.0f, 0.0f, 0.0f};
        high_[p] = {x + 1.0f, 1.0f, 1.0f, 0.0f};
        // Sums and differences of coordinates: wide enough to say nothing.
        for (const std::size_t entry : {p, p + kPatches}) {
            slant_low_[entry] = {-100.0f, -100.0f, -100.0f, 0.0f};
            slant_high_[entry] = {100.0f, 100.0f, 100.0f, 0.0f};
        }
    }
    void move_by(int patch, float way) {
        const auto p = static_cast<std::size_t>(patch);
        stride_low_[p] = {way, 0.0f, 0.0f, 0.0f};
        stride_high_[p] = {way, 0.0f, 0.0f, 0.0f};
    }
    void list_near(const std::vector<int>& patches) {
        near_.counts()[0] = static_cast<int>(patches.size());
        for (std::size_t k = 0; k < patches.size(); ++k) {
            near_others_[RowTable::kStride * k] = patches[k];
        }
    }
    /// patch, and how much nearer it has come
    void keep(const std::vector<std::pair<int, float>>& patches) {
        kept_.counts()[0] = static_cast<int>(patches.size());
        for (std::size_t k = 0; k < patches.size(); ++k) {
            kept_others_[RowTable::kStride * k] = patches[k].first;
            spent_[RowTable::kStride * k] = patches[k].second;
        }
    }
    std::vector<std::pair<int, float>> kept() {
        std::vector<std::pair<int, float>> all;
        for (int k = 0; k < kept_.counts()[0]; ++k) {
            const auto entry = static_cast<std::size_t>(RowTable::kStride * k);
            all.emplace_back(kept_others_[entry], spent_[entry]);
        }
        return all;
    }
    /// Whether patch 0 has to collect anew.
    bool is_stale() {
        const Launch check = launch(
            kernels::check_candidates, Segments{}, low_, high_, slant_low_, slant_high_,
            stride_low_, stride_high_, near_.rows(), near_.counts(), near_others_, kept_.rows(),
            kept_.counts(), kept_.needs(), kept_others_, spent_, slacks_, stamps_, stale_, epoch_,
            age_, age_, age_, age_, kPatches, kMargin, kSpare, 0.1f, 1.0f, 8.0f, 1.0f, 0);
        run_on_host(check, check.kernel->scalar, 0, 1);
        return stale_[0] != 0;
    }

private:
    /// Begins of strips: all patches are of one.
    struct OneStrip : Buffer<int> {
        OneStrip() : Buffer<int>("strips", 2) { (*this)[1] = kPatches; }
    };
    OneStrip begin_;
    RowTable near_{"near", {&begin_, 0, 1, 1}, kPatches};
    RowTable kept_{"kept", {&begin_, 0, 1, 1}, kPatches - 1};
    Buffer<int>& near_others_ = near_.add_column<int>("others");
    Buffer<int>& kept_others_ = kept_.add_column<int>("others");
    Buffer<float>& spent_ = kept_.add_column<float>("spent");
    Buffer<float4> low_{"low", kPatches}, high_{"high", kPatches};
    Buffer<float4> slant_low_{"slant_low", 2 * kPatches}, slant_high_{"slant_high", 2 * kPatches};
    Buffer<float4> stride_low_{"stride_low", kPatches}, stride_high_{"stride_high", kPatches};
    Buffer<float> slacks_{"slacks", kPatches};
    Buffer<int> stamps_{"stamps", kPatches}, stale_{"stale", kPatches};
    Buffer<int> epoch_{"epoch", 1}, age_{"age", 1};
};

TEST_F(Nearing, AddsUpUntilTheSlackIsSpent) {
    place(1, 0.5f);
    list_near({1});
    keep({{1, 0.0f}});
    move_by(1, -0.2f);
    EXPECT_FALSE(is_stale());
    EXPECT_FALSE(is_stale());
    EXPECT_FLOAT_EQ(kept().front().second, 0.4f);
    EXPECT_TRUE(is_stale());
    EXPECT_FLOAT_EQ(kept().front().second, 0.0f);
}

/// What slides past without touching may do so for ever.
TEST_F(Nearing, SpendsNothingWhileBoundsAreApart) {
    place(1, 1.3f);
    list_near({1});
    keep({{1, 0.4f}});
    move_by(1, -0.2f);
    EXPECT_FALSE(is_stale());
    EXPECT_FLOAT_EQ(kept().front().second, kSlack - (0.3f - kSpare));
}

TEST_F(Nearing, WhatComesFromAfarIsTakenInWithWhatIsLeftBetween) {
    place(1, 0.5f);
    place(2, 1.8f);
    place(3, -0.5f);
    keep({{1, 0.1f}, {3, 0.2f}});
    list_near({1, 2, 3});
    EXPECT_FALSE(is_stale());
    ASSERT_EQ(kept().size(), 3u);
    EXPECT_EQ(kept()[0], std::pair(1, 0.1f));
    EXPECT_EQ(kept()[1].first, 2);
    EXPECT_FLOAT_EQ(kept()[1].second, kSlack - (0.8f - kSpare));
    EXPECT_EQ(kept()[2], std::pair(3, 0.2f));
}

/// As where a sheet was too flat to touch itself there, and no longer is.
TEST_F(Nearing, WhatIsSuddenlyThereHasToBeLookedAt) {
    place(1, 0.5f);
    place(2, 0.9f);
    keep({{1, 0.0f}});
    list_near({1, 2});
    EXPECT_TRUE(is_stale());
    EXPECT_EQ(kept().size(), 2u);
}

TEST_F(Nearing, WhatIsPassedOverThoughItIsNearHasToGo) {
    place(1, 0.5f);
    place(2, 0.9f);
    keep({{1, 0.0f}, {2, 0.0f}});
    list_near({1});
    EXPECT_TRUE(is_stale());
    EXPECT_EQ(kept().size(), 1u);
}

TEST_F(Nearing, WhatHasLeftStaysUntilNothingIsNear) {
    place(1, 0.5f);
    keep({{1, 0.0f}, {2, 0.3f}});
    list_near({1});
    EXPECT_FALSE(is_stale());
    ASSERT_EQ(kept().size(), 2u);
    EXPECT_LT(kept()[1].second, 0.0f);
    list_near({});
    EXPECT_TRUE(is_stale());
    EXPECT_TRUE(kept().empty());
}

TEST_F(Nearing, ARowWithoutRoomIsMadeAnew) {
    for (int p = 1; p < kPatches; ++p) place(p, 1.5f);
    list_near({0, 1, 2});
    keep({{0, 0.0f}, {1, 0.0f}, {3, 0.0f}});
    EXPECT_TRUE(is_stale());
    ASSERT_EQ(kept().size(), 3u);
    EXPECT_EQ(kept()[2].first, 2);
}

}  // namespace
}  // namespace weft::test
