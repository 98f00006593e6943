#include "simulation/topology/components.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

std::vector<int> component_begins(int vertex_count, std::span<const Stencils> kinds) {
    const auto count = static_cast<std::size_t>(vertex_count);
    std::vector<int> opened(count + 1), closed(count + 1);  // elements that begin, end at a vertex
    for (const Stencils& kind : kinds) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto [low, high] = std::ranges::minmax(kind[e]);
            WEFT_ASSERT(low >= 0 && high < vertex_count);
            ++opened[static_cast<std::size_t>(low)];
            ++closed[static_cast<std::size_t>(high)];
        }
    }
    std::vector<int> begins;
    int open = 0;
    for (std::size_t v = 0; v < count; ++v) {
        if (open == 0) begins.push_back(static_cast<int>(v));
        open += opened[v] - closed[v];
    }
    WEFT_ASSERT(open == 0);
    begins.push_back(vertex_count);
    return begins;
}

}  // namespace weft
