#pragma once

#include <functional>
#include <memory>

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
/// Adds up what `sum_of(begin, end)` gives.
double sum_of_blocks(int count, const std::function<double(int begin, int end)>& sum_of);
/// The least of what `first_in(begin, end)` gives, which is an index, or -1 for none.
int first_of_blocks(int count, const std::function<int(int begin, int end)>& first_in);

}  // namespace weft
