#include "simulation/solver/partition.h"

namespace weft {

Partition Partition::whole(int strip_count) { return {{{0, strip_count}}}; }

Partition Partition::at(std::span<const int> cuts, int strip_count) {
    Partition partition = whole(strip_count);
    for (const int cut : cuts) {
        partition.parts.back().end = cut;
        partition.parts.push_back({cut, strip_count});
    }
    return partition;
}

}  // namespace weft
