#include "runtime/tbb/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <vector>

namespace weft {

namespace {

constexpr int kBlock = 2048;

/// As tbb::parallel_for(). TBB's library is not built for thread sanitizers, so they do not see
/// that its threads begin behind what was done before, and end before what comes behind: the
/// counter says both once more.
template <class... Partitioner>
void for_each_number(int count, const std::function<void(int number)>& action,
                     const Partitioner&... partitioner) {
    std::atomic<int> done;
    done.store(0, std::memory_order_release);
    const auto one = [&](int number) {
        (void)done.load(std::memory_order_acquire);
        action(number);
        done.fetch_add(1, std::memory_order_release);
    };
    tbb::parallel_for(0, count, one, partitioner...);
    (void)done.load(std::memory_order_acquire);
}

}  // namespace

class HostThreads::Arena {
public:
    explicit Arena(int count) : arena(count) {}
    tbb::task_arena arena;
};

HostThreads::HostThreads(int count) : arena_(std::make_unique<Arena>(count)) {}
HostThreads::~HostThreads() = default;

void HostThreads::execute(const std::function<void()>& action) const {
    arena_->arena.execute(action);
}

int block_count(int count) { return (count + kBlock - 1) / kBlock; }

void for_each_block(int count, const std::function<void(int block, int begin, int end)>& action) {
    const auto one = [&](int block) {
        const int begin = block * kBlock;
        action(block, begin, std::min(begin + kBlock, count));
    };
    if (count <= kBlock) {
        if (count > 0) one(0);
        return;
    }
    for_each_number(block_count(count), one);
}

void for_each_block(std::span<const BlockLoop> loops) {
    std::vector<int> ends;  // of the loops, in blocks of all
    for (const BlockLoop& loop : loops) {
        ends.push_back((ends.empty() ? 0 : ends.back()) + block_count(loop.count));
    }
    if (ends.empty()) return;
    for_each_number(ends.back(), [&](int number) {
        const auto found = std::ranges::upper_bound(ends, number) - ends.begin();
        const BlockLoop& loop = loops[static_cast<std::size_t>(found)];
        const int block =
            number - (ends[static_cast<std::size_t>(found)] - block_count(loop.count));
        const int begin = block * kBlock;
        loop.action(block, begin, std::min(begin + kBlock, loop.count));
    });
}

void for_each_apart(int count, const std::function<void(int i)>& action) {
    for_each_number(count, action, tbb::simple_partitioner());
}

double sum_of_blocks(int count, const std::function<double(int begin, int end)>& sum_of) {
    std::vector<double> sums(static_cast<std::size_t>(block_count(count)));
    for_each_block(count, [&](int block, int begin, int end) {
        sums[static_cast<std::size_t>(block)] = sum_of(begin, end);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace weft
