#include "runtime/tbb/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace weft {

namespace {

constexpr int kBlock = 2048;

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
    tbb::parallel_for(0, block_count(count), one);
}

double sum_of_blocks(int count, const std::function<double(int begin, int end)>& sum_of) {
    std::vector<double> sums(static_cast<std::size_t>(block_count(count)));
    for_each_block(count, [&](int block, int begin, int end) {
        sums[static_cast<std::size_t>(block)] = sum_of(begin, end);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

int first_of_blocks(int count, const std::function<int(int begin, int end)>& first_in) {
    std::vector<int> firsts(static_cast<std::size_t>(block_count(count)), -1);
    for_each_block(count, [&](int block, int begin, int end) {
        firsts[static_cast<std::size_t>(block)] = first_in(begin, end);
    });
    const auto found = std::ranges::find_if(firsts, [](int first) { return first >= 0; });
    return found == firsts.end() ? -1 : *found;
}

}  // namespace weft
