#include "kernels/newton/triangles.h"
#include "simulation/families/elastic_blocks.h"
#include "simulation/families/membranes/membranes.h"

namespace weft {

std::unique_ptr<BlockRows> Membranes::make_block_rows(const BlockList& list) {
    return std::make_unique<ElasticBlocks<Membranes, kernels::couple_membranes_kernel>>(*this,
                                                                                        list);
}

}  // namespace weft
