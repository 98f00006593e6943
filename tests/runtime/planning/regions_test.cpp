// The order of a region's parts, for every way to cut up to eight strips.

#include "runtime/planning/regions.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace weft::test {
namespace {

/// All ascending lists of cuts for so many strips.
std::vector<std::vector<int>> all_cuts(int strip_count) {
    std::vector<std::vector<int>> lists;
    for (unsigned bits = 0; bits < 1U << (strip_count - 1); ++bits) {
        std::vector<int>& cuts = lists.emplace_back();
        for (int cut = 1; cut < strip_count; ++cut) {
            if ((bits >> (cut - 1)) & 1U) cuts.push_back(cut);
        }
    }
    return lists;
}

void for_all_divisions(const std::function<void(int, const std::vector<Region>&)>& check) {
    for (int strips = 1; strips <= 8; ++strips) {
        for (const auto& cuts : all_cuts(strips))
            check(strips, regions_of(Partition::at(cuts, strips)));
    }
}

TEST(Regions, PartsAreEveryStripAndEverySeamOnce) {
    for_all_divisions([](int strips, const std::vector<Region>& regions) {
        std::vector<int> strip_visits(static_cast<std::size_t>(strips), 0);
        std::vector<int> seam_visits(static_cast<std::size_t>(strips), 0);
        const auto count = [](std::vector<int>& visits) {
            return [&visits](StripRange range) {
                const auto [begin, end] = range;
                EXPECT_LT(begin, end);
                for (int i = begin; i < end; ++i) ++visits[static_cast<std::size_t>(i)];
            };
        };
        for (const Region& region : regions) {
            for_each_part(region, count(seam_visits), count(strip_visits));
        }
        EXPECT_EQ(strip_visits, std::vector<int>(static_cast<std::size_t>(strips), 1));
        std::vector<int> every_seam(static_cast<std::size_t>(strips), 1);
        every_seam.back() = 0;  // none behind the last strip
        EXPECT_EQ(seam_visits, every_seam);
    });
}

TEST(Regions, SeamsComeBeforeTheStripsThatTheyTouch) {
    for_all_divisions([](int strips, const std::vector<Region>& regions) {
        std::vector<bool> done(static_cast<std::size_t>(strips), false);  // [strip]
        const auto is_done = [&](int strip) {
            return strip < strips && done[static_cast<std::size_t>(strip)];
        };
        for (const Region& region : regions) {
            for_each_part(
                region,
                [&](StripRange seams) {
                    for (int strip = seams.begin; strip <= seams.end; ++strip)
                        EXPECT_FALSE(is_done(strip));
                },
                [&](StripRange range) {
                    for (int s = range.begin; s < range.end; ++s)
                        done[static_cast<std::size_t>(s)] = true;
                });
        }
    });
}

TEST(Regions, TheStripBehindACutComesLastAndTheOpenSeamInTheMiddle) {
    const auto regions = regions_of(Partition::at(std::vector<int>{10}, 20));
    std::vector<std::pair<char, int>> first, second;  // kind, first strip or seam
    const auto list = [](auto& into, char kind) {
        return [&into, kind](StripRange range) { into.emplace_back(kind, range.begin); };
    };
    for_each_part(regions[0], list(first, 'm'), list(first, 't'));
    for_each_part(regions[1], list(second, 'm'), list(second, 't'));
    using Parts = std::vector<std::pair<char, int>>;
    EXPECT_EQ(first, (Parts{{'m', 0}, {'t', 0}, {'m', 9}, {'t', 5}}));
    EXPECT_EQ(second, (Parts{{'m', 10}, {'t', 11}, {'t', 10}}));
}

TEST(Regions, SharesAreEveryStripOnceAndThoseBesideCutsFirst) {
    for_all_divisions([](int strips, const std::vector<Region>& regions) {
        std::vector<int> visits(static_cast<std::size_t>(strips), 0);
        for (const Region& region : regions) {
            bool inside = false;  // past the strips beside cuts
            for_each_share(region, [&](StripRange range) {
                const auto [begin, end] = range;
                EXPECT_LT(begin, end);
                for (int s = begin; s < end; ++s) ++visits[static_cast<std::size_t>(s)];
                const bool beside_cut = (region.cut_before && begin == region.begin) ||
                                        (region.cut_behind && end == region.end);
                EXPECT_FALSE(inside && beside_cut);
                inside = inside || !beside_cut;
            });
        }
        EXPECT_EQ(visits, std::vector<int>(static_cast<std::size_t>(strips), 1));
    });
}

}  // namespace
}  // namespace weft::test
