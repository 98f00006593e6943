#include "runtime/tbb/parallel.h"

#include <gtest/gtest.h>

#include <vector>

namespace weft {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

TEST(Parallel, LoopsAtOnceAreEachCutAsOneAlone) {
    const std::vector<int> counts{5000, 0, 1, 2048, 4097};
    const HostThreads threads(2);
    for (const int count : counts) {
        std::vector<int> blocks(at(count), -1);
        for_each_block(count, [&](int block, int begin, int end) {
            for (int i = begin; i < end; ++i) blocks[at(i)] = block;
        });
        std::vector<std::vector<int>> found;
        for (const int each : counts) found.emplace_back(at(each), -1);
        std::vector<BlockLoop> loops;
        for (auto& list : found) {
            loops.push_back({static_cast<int>(list.size()), [&list](int block, int begin, int end) {
                                 for (int i = begin; i < end; ++i) list[at(i)] = block;
                             }});
        }
        threads.execute([&] { for_each_block(loops); });
        for (const auto& list : found) {
            if (std::ssize(list) != count) continue;
            EXPECT_EQ(list, blocks);
        }
    }
}

TEST(Parallel, NoLoopsAreNothingToDo) { for_each_block(std::vector<BlockLoop>{}); }

TEST(Parallel, ThingsApartAreEachDoneOnce) {
    std::vector<int> done(100);
    const HostThreads threads(2);
    threads.execute([&] { for_each_apart(100, [&](int i) { ++done[at(i)]; }); });
    EXPECT_EQ(done, std::vector<int>(100, 1));
    for_each_apart(0, [](int) { FAIL(); });
}

}  // namespace
}  // namespace weft
