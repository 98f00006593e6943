#include "kernels/newton/springs.h"
#include "simulation/families/springs/springs.h"

namespace weft {

namespace {

class SpringBlocks final : public BlockRows {
public:
    SpringBlocks(const Springs& springs, const BlockList& list)
        : tables_("springs", springs.elements(), list),
          material_("springs.block_material", 2 * tables_.entries()) {
        tables_.fill(material_, [&](int spring, const std::array<int, 4>&) {
            return FewNumbers{springs.rest_length(spring), springs.stiffness(spring)};
        });
        tables_.filled();
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_springs, t.segments, t.positions, t.before, t.after,
                       tables_.slices(), tables_.corners(), material_, t.blocks, t.block_count,
                       tables_.entry_count(), t.columns, SlicedRows::kStride, t.fresh)};
    }

private:
    BlockRowTables tables_;
    Buffer<float> material_;
};

}  // namespace

std::unique_ptr<BlockRows> Springs::make_block_rows(const BlockList& list) {
    return std::make_unique<SpringBlocks>(*this, list);
}

}  // namespace weft
