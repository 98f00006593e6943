#include "kernels/newton/springs.h"
#include "simulation/families/stitches/stitches.h"

namespace weft {

namespace {

class StitchBlocks final : public BlockRows {
public:
    StitchBlocks(Stitches& stitches, const BlockList& list)
        : tables_("stitches", stitches.elements(), list),
          material_("stitches.block_material", 3 * tables_.entries()),
          clock_(*stitches.clock) {
        tables_.fill(material_, [&](int stitch, const std::array<int, 4>&) {
            return FewNumbers{stitches.start(stitch), stitches.stiffness(stitch),
                              stitches.rate(stitch)};
        });
        tables_.filled();
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_stitches, t.segments, t.positions, tables_.slices(),
                       tables_.corners(), material_, clock_, t.blocks, t.block_count,
                       tables_.entry_count(), t.columns, SlicedRows::kStride, t.fresh, kInstance)};
    }

private:
    BlockRowTables tables_;
    Buffer<float> material_;
    Buffer<float>& clock_;
};

}  // namespace

std::unique_ptr<BlockRows> Stitches::make_block_rows(const BlockList& list) {
    return std::make_unique<StitchBlocks>(*this, list);
}

}  // namespace weft
