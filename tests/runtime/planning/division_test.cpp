#include "runtime/planning/division_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace weft::test {
namespace {

int sum(const Division& division) {
    return std::accumulate(division.strips.begin(), division.strips.end(), 0);
}

TEST(Division, SingleGivesAllToOne) {
    const Division division = Division::single(3, 20, 1);
    EXPECT_EQ(division.strips, (std::vector<int>{0, 20, 0}));
    EXPECT_EQ(division.devices(), std::vector<int>{1});
    EXPECT_EQ(division.partition(), Partition::whole(20));
    EXPECT_EQ(division.mask(), 2U);
}

TEST(Division, CutsAreWhereRegionsMeet) {
    const Division division{{3, 0, 5, 2}};
    EXPECT_EQ(division.devices(), (std::vector<int>{0, 2, 3}));
    EXPECT_EQ(division.partition(), Partition::at(std::vector<int>{3, 8}, 10));
    EXPECT_EQ(division.partition().parts, (std::vector<Part>{{0, 3}, {3, 8}, {8, 10}}));
    EXPECT_EQ(division.mask(), 0b1101U);
}

TEST(Division, DistanceIsTheMostStripsOfAnyDevice) {
    const Division one{{3, 0, 5, 2}};
    EXPECT_EQ(one.distance(one), 0);
    EXPECT_EQ(one.distance({{3, 1, 4, 2}}), 1);
    EXPECT_EQ(one.distance({{2, 4, 4, 0}}), 4);
}

TEST(Division, ProportionalIsWithinAStripOfTheShares) {
    const std::vector<std::vector<double>> speeds{
        {1.0}, {1.0, 1.0}, {1.0, 3.0}, {5.0, 0.1}, {0.01, 100.0, 1.0}, {2.0, 3.0, 4.0, 5.0}};
    for (const auto& speed : speeds) {
        const double all = std::accumulate(speed.begin(), speed.end(), 0.0);
        for (int strips = 1; strips <= 40; ++strips) {
            const Division division = Division::proportional(strips, speed);
            ASSERT_EQ(division.strips.size(), speed.size());
            EXPECT_EQ(sum(division), strips);
            for (std::size_t d = 0; d < speed.size(); ++d) {
                EXPECT_GE(division.strips[d], 0);
                if (strips < static_cast<int>(speed.size())) continue;
                EXPECT_GE(division.strips[d], 1) << "everyone gets something";
                // One strip by rounding, and one for each device that would otherwise have none.
                EXPECT_NEAR(division.strips[d], speed[d] / all * strips,
                            static_cast<double>(speed.size()));
            }
        }
    }
}

TEST(Division, NeighboursAreOneStripAwayBothWays) {
    for (const Division& division : {Division{{4, 6}}, Division{{0, 10}}, Division{{1, 0, 5}}}) {
        std::vector<int> all(division.strips.size());
        std::iota(all.begin(), all.end(), 0);
        for (const Division& neighbour : division.neighbours(all)) {
            EXPECT_EQ(sum(neighbour), sum(division));
            int moved = 0;
            for (std::size_t d = 0; d < division.strips.size(); ++d) {
                EXPECT_GE(neighbour.strips[d], 0);
                moved += std::abs(neighbour.strips[d] - division.strips[d]);
            }
            EXPECT_EQ(moved, 2);
            const auto back = neighbour.neighbours(all);
            EXPECT_NE(std::find(back.begin(), back.end(), division), back.end());
        }
    }
    EXPECT_EQ((Division{{1, 6, 3}}.distance(Division{{4, 4, 2}})), 3);
    const std::vector<int> two{0, 1};
    EXPECT_EQ((Division{{4, 6}}.neighbours(two).size()), 2U);
    EXPECT_EQ((Division{{0, 10}}.neighbours(two).size()), 1U);
}

/// Devices that take their strips one after the other, and a price for each that takes part.
TEST(DivisionSearch, FindsTheBestDivision) {
    constexpr int kStrips = 24;
    const std::vector<std::vector<double>> all_speeds{
        {1.0, 1.0}, {1.0, 3.0}, {5.0, 1.0, 2.0}, {1.0, 50.0}, {2.0, 0.0, 1.0}};
    for (const std::vector<double>& speed : all_speeds) {
        const auto devices = static_cast<int>(speed.size());
        std::vector<int> all(speed.size());
        std::iota(all.begin(), all.end(), 0);
        const auto time = [&](const Division& division) {
            double longest = 0.0;
            for (std::size_t d = 0; d < speed.size(); ++d) {
                if (division.strips[d] == 0) continue;
                longest = std::max(longest, division.strips[d] / speed[d]);
            }
            return longest + 0.5 * static_cast<double>(division.devices().size());
        };
        const DivisionSearch search(devices, kStrips, all, time);
        double best = std::numeric_limits<double>::infinity();
        for (int first = 0; first <= kStrips; ++first) {
            for (int second = 0; first + second <= kStrips; ++second) {
                Division division{{first, second}};
                if (devices == 3) division.strips.push_back(kStrips - first - second);
                if (sum(division) == kStrips) best = std::min(best, time(division));
            }
        }
        EXPECT_LE(time(search.best()), best * (1.0 + 1e-9)) << devices << " devices";
        EXPECT_EQ(sum(search.best()), kStrips);
    }
}

TEST(DivisionSearch, GivesNothingToWhoCannot) {
    const auto time = [](const Division& division) {
        return division.strips[1] > 0 ? std::numeric_limits<double>::infinity()
                                      : 1.0 * std::ranges::max(division.strips);
    };
    const DivisionSearch search(3, 10, {0, 1, 2}, time);
    EXPECT_EQ(search.by_speed().strips, (std::vector{5, 0, 5}));
    EXPECT_EQ(search.best().strips, (std::vector{5, 0, 5}));
}

}  // namespace
}  // namespace weft::test
