#pragma once

#include <functional>
#include <memory>
#include <span>

namespace weft {

/// Host threads for what is done between frames, when devices rest.
class HostThreads {
public:
    explicit HostThreads(int count);
    ~HostThreads();

    /// The blocks of what `action` does are shared by these threads.
    void execute(const std::function<void()>& action) const;

private:
    class Arena;
    std::unique_ptr<Arena> arena_;
};

/// Cuts [0, count) into blocks, for the threads that this is called in. Blocks do not depend on
/// these: what is kept by block, and put together in their order, is the same whatever they are.
int block_count(int count);
void for_each_block(int count, const std::function<void(int block, int begin, int end)>& action);
/// What for_each_block() does.
struct BlockLoop {
    int count;
    std::function<void(int block, int begin, int end)> action;
};
/// Several loops at once, none of which needs another: other threads are woken once for all.
void for_each_block(std::span<const BlockLoop> loops);
/// Calls action(i) for each i in [0, count), in any order: for few things that each take long.
void for_each_apart(int count, const std::function<void(int i)>& action);
/// Adds up what `sum_of(begin, end)` gives.
double sum_of_blocks(int count, const std::function<double(int begin, int end)>& sum_of);

}  // namespace weft
