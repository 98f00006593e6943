#include "runtime/planning/regions.h"

#include "scheduler/assert.h"

namespace weft {

std::vector<Region> regions_of(const Partition& partition) {
    WEFT_ASSERT(!partition.parts.empty());
    std::vector<Region> regions;
    const int last = static_cast<int>(partition.parts.size()) - 1;
    for (int r = 0; r <= last; ++r) {
        const Part& part = partition.parts[static_cast<std::size_t>(r)];
        WEFT_ASSERT(part.begin == (r == 0 ? 0 : regions.back().end));
        WEFT_ASSERT(part.begin < part.end);
        regions.push_back({RegionId{r}, part.begin, part.end, r > 0, r < last});
    }
    return regions;
}

}  // namespace weft
