#include "runtime/planning/partition.h"

#include "scheduler/assert.h"

namespace weft {

Partition Partition::whole(int strip_count) { return {{{0, strip_count}}}; }

Partition Partition::at(std::span<const int> cuts, int strip_count) {
    Partition partition = whole(strip_count);
    for (const int cut : cuts) {
        WEFT_ASSERT(partition.parts.back().begin < cut && cut < strip_count);
        partition.parts.back().end = cut;
        partition.parts.push_back({cut, strip_count});
    }
    return partition;
}

Partition Partition::spread(int iterates) const {
    Partition partition = *this;
    for (std::size_t r = 0; r < parts.size(); ++r) {
        partition.parts[r].iterate = static_cast<int>(r) % iterates;
    }
    return partition;
}

}  // namespace weft
