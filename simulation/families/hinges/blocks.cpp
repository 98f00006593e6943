#include "simulation/families/constant_blocks.h"
#include "simulation/families/hinges/hinges.h"

namespace weft {

std::unique_ptr<BlockRows> Hinges::make_block_rows(const BlockList& list) {
    return std::make_unique<ConstantBlocks<Hinges>>(*this, list);
}

}  // namespace weft
