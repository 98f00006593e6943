#include "kernels/newton/hinges.h"
#include "simulation/families/curved_hinges/curved_hinges.h"

namespace weft {

namespace {

/// Of both parts of J_j = q_j I + [v_j]x the second one is left out; what is left is constant.
class NearlyFlatBlocks final : public BlockRows {
public:
    NearlyFlatBlocks(const CurvedHinges& hinges, const BlockList& list)
        : weights_("curved_hinges.block_weights", static_cast<std::size_t>(list.count())) {
        for (int block = 0; block < list.count(); ++block) {
            double sum = 0.0;
            for (const Coupling& c : list[block]) {
                sum -= hinges.weight(c.element, c.j) * hinges.weight(c.element, c.k);
            }
            weights_[block] = static_cast<float>(sum);
        }
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_hinges, t.segments, weights_, t.blocks, t.block_count,
                       t.columns, t.fresh)};
    }

private:
    Buffer<float> weights_;
};

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

std::unique_ptr<BlockRows> CurvedHinges::make_block_rows(const BlockList& list) {
    if (is_nearly_flat_) return std::make_unique<NearlyFlatBlocks>(*this, list);
    return std::make_unique<CurvedHingeBlocks>(*this, list);
}

}  // namespace weft
