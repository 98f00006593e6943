#include "simulation/solver/regions.h"

namespace weft {

std::vector<Region> regions_between(std::span<const int> cuts, int strip_count) {
    std::vector<Region> regions{{0, 0, strip_count, false, false}};
    for (const int cut : cuts) {
        Region& before = regions.back();
        before.end = cut;
        before.cut_behind = true;
        regions.push_back({before.id + 1, cut, strip_count, true, false});
    }
    return regions;
}

}  // namespace weft
