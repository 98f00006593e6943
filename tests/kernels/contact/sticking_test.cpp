// What vertices keep of the slips of their contacts, and what the contacts of the next substep have
// of it.

#include "kernels/contact/sticking.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "runtime/row_table.h"
#include "simulation/families/convert.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kRange = 0.1f;
constexpr float kGap = 0.05f;
constexpr float kCreep = 1e-3f;

/// Vertices over each other, each of which meets the one below it, by contacts that are found where
/// they stand. The lowest one may be held.
class Pile {
public:
    Pile(int count, bool is_held)
        : count_(count),
          begin_("strips", 2),
          positions_("positions", size()),
          table_("contacts", segments(), 2),
          kept_("kept", 3 * size()) {
        for (int v = 0; v < count; ++v) {
            positions_[at(v)] = {0.0f, kGap * static_cast<float>(v), 0.0f, 1.0f};
        }
        if (is_held) positions_[0].w = 0.0f;
    }

    /// Another substep begins: contacts are found anew.
    void find() {
        for (int& count : table_.counts().span()) count = 0;
        for (int v = 1; v < count_; ++v) {
            add_entry(v, v, v - 1, 1.0f);
            if (positions_[at(v - 1)].w > 0.0f) add_entry(v - 1, v, v - 1, -1.0f);
        }
        const Launch recall = launch(kernels::recall_slips, Segments{}, positions_, kept_,
                                     table_.rows(), table_.counts(), c0_, c1_, c2_, c3_, normals_,
                                     weights_, measures_, slips_, count_);
        run_on_host(recall, recall.kernel->scalar, 0, count_);
    }

    /// It ends, when a vertex has gone so far to the side [m].
    void end(const std::vector<float>& ways) {
        for (int v = 0; v < count_; ++v) positions_[at(v)].x = ways[at(v)];
        const Launch keep =
            launch(kernels::keep_slips, Segments{}, positions_, table_.rows(), table_.counts(), c0_,
                   c1_, c2_, c3_, normals_, weights_, measures_, slips_, kept_, count_, kCreep);
        run_on_host(keep, keep.kernel->scalar, 0, count_);
        for (int v = 0; v < count_; ++v) positions_[at(v)].x = 0.0f;  // where they stand now
    }

    void lift(float way) { positions_[at(count_ - 1)].y += way; }

    /// Of this vertex along the one below it, when the substep began [m].
    float slip_on_lower(int vertex) { return slips_[at(table_.rows()[at(vertex)])].x; }

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    std::size_t size() const { return at(count_); }
    Segments segments() {
        begin_[1] = count_;
        return {&begin_, 0, 1, 1};
    }

    /// side: 1 for the upper one, -1 for the lower one
    void add_entry(int vertex, int upper, int lower, float side) {
        const auto entry =
            at(table_.rows()[at(vertex)] + RowTable::kStride * table_.counts()[at(vertex)]++);
        c0_[entry] = c1_[entry] = c2_[entry] = upper;
        c3_[entry] = lower;
        normals_[entry] = {0.0f, side, 0.0f, kGap};
        weights_[entry] = {side, 0.0f, 0.0f, -side};
        const float spread = positions_[at(lower)].w > 0.0f ? 2.0f : 1.0f;
        measures_[entry] = {1.0f, spread, 100.0f, kRange};
    }

    int count_;
    Buffer<int> begin_;
    Buffer<float4> positions_;
    RowTable table_;
    Buffer<int>& c0_ = table_.add_column<int>("corner0");
    Buffer<int>& c1_ = table_.add_column<int>("corner1");
    Buffer<int>& c2_ = table_.add_column<int>("corner2");
    Buffer<int>& c3_ = table_.add_column<int>("corner3");
    Buffer<float4>& normals_ = table_.add_column<float4>("normals");
    Buffer<float4>& weights_ = table_.add_column<float4>("weights");
    Buffer<float4>& measures_ = table_.add_column<float4>("measures");
    Buffer<float4>& slips_ = table_.add_column<float4>("slips");
    Buffer<float4> kept_;
};

TEST(Sticking, KeepsWhatIsShorterThanTheCreep) {
    for (const bool is_held : {true, false}) {
        Pile pile(2, is_held);
        pile.find();
        EXPECT_EQ(pile.slip_on_lower(1), 0.0f);
        pile.end({0.0f, 0.4f * kCreep});
        pile.find();
        EXPECT_NEAR(pile.slip_on_lower(1), 0.4f * kCreep, 1e-8f);
        pile.end({0.0f, 0.3f * kCreep});
        pile.find();
        EXPECT_NEAR(pile.slip_on_lower(1), 0.7f * kCreep, 1e-8f) << "it adds up";
        pile.end({0.0f, -0.7f * kCreep});
        pile.find();
        EXPECT_NEAR(pile.slip_on_lower(1), 0.0f, 1e-8f) << "back where it was";
    }
}

TEST(Sticking, LetsGoWhatSlides) {
    for (const bool is_held : {true, false}) {
        Pile pile(2, is_held);
        pile.find();
        pile.end({0.0f, 7.0f * kCreep});
        pile.find();
        EXPECT_NEAR(pile.slip_on_lower(1), kCreep, 1e-8f);
    }
}

/// What a pile is pulled by goes through all of it: each is held back from below, and pulled along
/// from above, so the slips on both of its sides are opposite ones.
TEST(Sticking, KeepsASlipForEachSide) {
    Pile pile(3, true);
    const float slip = 0.5f * kCreep;
    pile.find();
    pile.end({0.0f, slip, 2.0f * slip});
    pile.find();
    EXPECT_NEAR(pile.slip_on_lower(1), slip, 1e-8f);
    EXPECT_NEAR(pile.slip_on_lower(2), slip, 1e-8f);
}

/// After a few iterations what presses comes and goes.
TEST(Sticking, KeepsASlipWhereAContactHardlyOpens) {
    const float to_the_range = kRange - kGap;
    for (const float gap : {0.9f * WEFT_STICKING_GAP, 1.1f * WEFT_STICKING_GAP}) {
        Pile pile(2, true);
        pile.find();
        pile.lift(to_the_range + gap * kRange);
        pile.end({0.0f, 0.4f * kCreep});
        pile.find();
        const float kept = gap < WEFT_STICKING_GAP ? 0.4f * kCreep : 0.0f;
        EXPECT_NEAR(pile.slip_on_lower(1), kept, 1e-8f);
    }
}

TEST(Sticking, ForgetsWhatHasParted) {
    Pile pile(2, true);
    pile.find();
    pile.end({0.0f, 0.4f * kCreep});
    pile.lift(kRange);
    pile.find();
    pile.end({0.0f, 0.0f});
    pile.lift(-kRange);
    pile.find();
    EXPECT_EQ(pile.slip_on_lower(1), 0.0f);
}

}  // namespace
}  // namespace weft::test
