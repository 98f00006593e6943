#include "kernels/newton/triangles.h"
#include "simulation/families/elastic_blocks.h"
#include "simulation/families/woven/woven.h"

namespace weft {

std::unique_ptr<BlockRows> WovenCloth::make_block_rows(const BlockList& list) {
    return std::make_unique<ElasticBlocks<WovenCloth, kernels::couple_woven_kernel>>(*this, list);
}

}  // namespace weft
