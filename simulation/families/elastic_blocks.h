#pragma once

#include "simulation/families/block_rows.h"
#include "simulation/families/family.h"

namespace weft {

/// Blocks for kernels that take the tables corners, shape and material, of families as in
/// elastic_solvers.h.
template <class Family, class Kernel>
class ElasticBlocks final : public BlockRows {
public:
    ElasticBlocks(const Family& family, const BlockList& list)
        : tables_(family.names().name, family.elements(), list),
          shape_(family.names().name + ".block_shape",
                 tables_.entries() * (static_cast<std::size_t>(family.elements().arity()) - 1) *
                     family.shape_gradient(0, 0).size()),
          material_(family.names().name + ".block_material",
                    tables_.entries() * columns_of(family)) {
        tables_.fill(shape_, [&](int element, const std::array<int, 4>& corners) {
            FewNumbers numbers;
            for (int c = 1; c < family.elements().arity(); ++c) {
                const int corner = corners[static_cast<std::size_t>(c)];
                for (const double b : family.shape_gradient(element, corner)) numbers.push_back(b);
            }
            return numbers;
        });
        tables_.fill(material_, [&](int element, const std::array<int, 4>&) {
            const auto count = static_cast<std::size_t>(family.count());
            FewNumbers numbers;
            for (std::size_t c = 0; c < columns_of(family); ++c) {
                const std::size_t place = c * count + static_cast<std::size_t>(element);
                numbers.push_back(static_cast<double>(family.material[place]));
            }
            return numbers;
        });
        tables_.filled();
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(Kernel{}, t.segments, t.positions, tables_.slices(), tables_.corners(),
                       shape_, material_, t.blocks, t.block_count, tables_.entry_count(), t.columns,
                       SlicedRows::kStride, t.fresh)};
    }

private:
    static std::size_t columns_of(const Family& family) {
        return family.material.count() / static_cast<std::size_t>(family.count());
    }

    BlockRowTables tables_;
    Buffer<float> shape_;
    Buffer<float> material_;
};

}  // namespace weft
