#include "kernels/newton/hinges.h"
#include "simulation/families/constant_blocks.h"
#include "simulation/families/curved_hinges/curved_hinges.h"

namespace weft {

namespace {

class CurvedHingeBlocks final : public BlockRows {
public:
    CurvedHingeBlocks(const CurvedHinges& hinges, const BlockList& list)
        : tables_("curved_hinges", hinges.elements(), list),
          weights_("curved_hinges.block_weights", 7 * tables_.entries()) {
        tables_.fill(weights_, [&](int hinge, const std::array<int, 4>& at) {
            return FewNumbers{hinges.weight(hinge, at[0]),
                              hinges.weight(hinge, at[1]),
                              hinges.pair_weight(hinge, at[0], at[1]),
                              hinges.pair_weight(hinge, at[0], at[2]),
                              hinges.pair_weight(hinge, at[0], at[3]),
                              hinges.pair_weight(hinge, at[1], at[2]),
                              hinges.pair_weight(hinge, at[1], at[3])};
        });
        tables_.filled();
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_curved_hinges, t.segments, t.positions, tables_.slices(),
                       tables_.corners(), weights_, t.blocks, t.block_count, tables_.entry_count(),
                       t.columns, SlicedRows::kStride, t.fresh)};
    }

private:
    BlockRowTables tables_;
    Buffer<float> weights_;
};

}  // namespace

/// Of both parts of J_j = q_j I + [v_j]x the second one is left out where hinges are nearly flat.
std::unique_ptr<BlockRows> CurvedHinges::make_block_rows(const BlockList& list) {
    if (is_nearly_flat_) return std::make_unique<ConstantBlocks<CurvedHinges>>(*this, list);
    return std::make_unique<CurvedHingeBlocks>(*this, list);
}

}  // namespace weft
