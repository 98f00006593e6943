// What alternatives cost, and what they give to whom: of work whose times are known, in numbers
// that can be worked out by hand.

#include "runtime/planning/candidates.h"

#include <gtest/gtest.h>

#include "tests/runtime/planning/two_stages.h"
#include "tests/runtime/planning/virtual_machine.h"

namespace weft::test {
namespace {

/// The costs of both stages on two devices, each with its time for all of a's and b's items.
KindCosts costs_of(int items_of_a, int items_of_b, const TimingModel& timing) {
    constexpr int kStrips = 5;
    TwoStages work(kStrips, items_of_a, items_of_b);
    KindCosts costs({0, 1}, 2);
    costs.sum_up(work.make_step(Partition::whole(kStrips)), timing);
    return costs;
}

TEST(KindCosts, DifferByKindsThatTakeTheirShareOfTheTime) {
    const auto differ = [](int a, int b, double b_on_second) {
        return costs_of(a, b, known_times({{1.0, 1.0}, {1.0, b_on_second}})).differ();
    };
    EXPECT_TRUE(differ(95, 5, 0.4)) << "a twentieth of the first device's time";
    EXPECT_FALSE(differ(96, 4, 0.4));
    EXPECT_TRUE(differ(5, 95, 0.4));
    EXPECT_TRUE(differ(50, 50, 0.6));
    EXPECT_FALSE(differ(50, 50, 0.7)) << "not so much better";
    EXPECT_FALSE(differ(50, 50, 1.0));
}

/// Both are best on the first device. All of a on the second one gives 10.5 s; half of both gives
/// 10.75 s.
TEST(KindCosts, BalanceMayGiveAKindAway) {
    const KindCosts costs = costs_of(10, 10, known_times({{1.0, 1.05}, {1.0, 1.1}}));
    const std::vector<Division> shares = costs.balance(10);
    EXPECT_EQ(shares, (std::vector{Division{{0, 10}}, Division{{10, 0}}}));
}

/// At first 32 s and 8 s; with 6 of a's 32 strips handed over, 26 s each.
TEST(KindCosts, BalanceHandsOverWhatMakesDevicesEquallyBusy) {
    const KindCosts costs = costs_of(320, 320, known_times({{0.1, 0.3}, {2.5, 0.025}}));
    const std::vector<Division> shares = costs.balance(32);
    EXPECT_EQ(shares, (std::vector{Division{{26, 6}}, Division{{0, 32}}}));
}

class CandidatesTest : public testing::Test {
protected:
    static constexpr int kStrips = 8;

    TwoStages work_{kStrips, 64, 64};
    VirtualMachine machine_{{{}, {}}, 0.0};
    TimingModel timing_ = known_times({{1.0, 1.0}, {1.0, 1.0}});
};

/// Neighbouring strips that go together share one latency.
TEST_F(CandidatesTest, MovingTakesALatencyForEachRunOfStripsAndTheTimeOfTheirBytes) {
    const double strip = work_.written_bytes() / kStrips;
    timing_.set_link(0, 1, {0.5, strip});         // a second for each strip
    timing_.set_link(1, 0, {0.25, 2.0 * strip});  // half of one
    Candidates candidates(work_, kStrips, machine_.devices(), timing_);
    const std::vector<int> first(kStrips, 0);
    EXPECT_DOUBLE_EQ(candidates.moving_time(first, 0), 0.0);
    EXPECT_DOUBLE_EQ(candidates.moving_time(first, 1), 0.5 + 8.0);
    EXPECT_DOUBLE_EQ(candidates.moving_time({0, 1, 0, 0, 1, 0, 1, 1}, 1), 3 * 0.5 + 4.0);
    // The mixture has 0 0 0 0 1 1 1 1.
    EXPECT_DOUBLE_EQ(candidates.moving_time({1, 1, 0, 0, 1, 1, 0, 0}, candidates.mixture_of(0)),
                     0.25 + 2 * 0.5 + 0.5 + 2.0);
}

TEST_F(CandidatesTest, MovingTakesTimeWhereOnlyOneWayIsACopy) {
    timing_.set_link(1, 0, {0.25, work_.written_bytes()});
    Candidates candidates(work_, kStrips, machine_.devices(), timing_);
    EXPECT_DOUBLE_EQ(candidates.moving_time(std::vector<int>(kStrips, 1), 0), 0.25 + 1.0);
}

TEST_F(CandidatesTest, MovingTakesNothingWhereNothingIsCopied) {
    Candidates candidates(work_, kStrips, machine_.devices(), timing_);
    EXPECT_EQ(candidates.moving_time(std::vector<int>(kStrips, 1), 0), 0.0);
}

/// What lies in memory behind the last strip is no device.
TEST_F(CandidatesTest, MovingAsksForNoMoreThanTheStripsThereAre) {
    timing_.set_link(0, 1, {0.0, work_.written_bytes()});
    Candidates candidates(work_, kStrips, machine_.devices(), timing_);
    std::vector<int> from(kStrips, 0);
    from.push_back(1 << 28);
    from.pop_back();
    EXPECT_DOUBLE_EQ(candidates.moving_time(from, 1), 1.0);
}

TEST(Candidates, ADivisionIsTheMixtureOfItsDevicesTeam) {
    TwoStages work(8, 64, 64);
    const VirtualMachine machine({{}, {}, {}, {}}, 0.0, {0, 0, 1, 1});
    const TimingModel timing = known_times({{1.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 1.0, 1.0}});
    const Candidates candidates(work, 8, machine.devices(), timing);
    ASSERT_EQ(candidates.team_count(), 2U);
    EXPECT_EQ(candidates.alternative_of({{3, 5, 0, 0}}), candidates.mixture_of(0));
    EXPECT_EQ(candidates.alternative_of({{0, 0, 3, 5}}), candidates.mixture_of(1));
    EXPECT_EQ(candidates.alternative_of({{0, 0, 8, 0}}), 2U);
}

/// Stage a is shared 26 to 6 (see above), stage b is the second device's.
TEST(PlacedTasks, AreCutWhereSharesEndAndALittleBesideThat) {
    constexpr int kStrips = 32;
    TwoStages work(kStrips, 320, 320);
    const TimingModel timing = known_times({{0.1, 0.3}, {2.5, 0.025}});
    StepGraphs graphs(work, 2);
    Placement placement(graphs, kStrips, {0, 1});
    ASSERT_TRUE(placement.possible());
    EXPECT_FALSE(placement.known());
    placement.improve(graphs.of({16, 16})->step(), timing);  // the shares are its first attempt
    ASSERT_TRUE(placement.known());
    FramePlan plan;
    placement.fill(timing, plan);
    std::vector<int> parts(12, 2);  // up to 24
    parts.insert(parts.end(), {1, 1, 1, 1, 2, 2});
    EXPECT_EQ(plan.parts, parts);

    std::vector<int> homes(26, 0);  // where a is done, which comes first
    homes.resize(kStrips, 1);
    EXPECT_EQ(placement.homes(), homes);
}

}  // namespace
}  // namespace weft::test
