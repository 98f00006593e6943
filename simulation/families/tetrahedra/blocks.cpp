#include "kernels/newton/tetrahedra.h"
#include "simulation/families/elastic_blocks.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

std::unique_ptr<BlockRows> Tetrahedra::make_block_rows(const BlockList& list) {
    return std::make_unique<ElasticBlocks<Tetrahedra, kernels::couple_tetrahedra_kernel>>(*this,
                                                                                          list);
}

}  // namespace weft
