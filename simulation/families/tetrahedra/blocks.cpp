#include "kernels/newton/tetrahedra.h"
#include "simulation/families/element_block_tables.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

class TetrahedronBlocks final : public BlockRows {
public:
    TetrahedronBlocks(const Tetrahedra& tetrahedra, const BlockList& list)
        : tables_(tetrahedra.names().name, tetrahedra.elements(), list),
          shape_("tetrahedra.piece_shape", 9 * static_cast<std::size_t>(tables_.piece_count())),
          material_("tetrahedra.piece_material",
                    2 * static_cast<std::size_t>(tables_.piece_count())) {
        tables_.fill(shape_, [&](int tetrahedron) {
            FewNumbers numbers;
            for (const int corner : {1, 2, 3}) {
                for (const double b : tetrahedra.shape_gradient(tetrahedron, corner)) {
                    numbers.push_back(b);
                }
            }
            return numbers;
        });
        tables_.fill(material_, [&](int tetrahedron) {
            return FewNumbers{tetrahedra.mu(tetrahedron), tetrahedra.lambda(tetrahedron)};
        });
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {
            launch(kernels::block_tetrahedra, tables_.segments(), t.positions, tables_.corners(),
                   shape_, material_, tables_.places(), tables_.blocks(), tables_.piece_count()),
            tables_.sum(t)};
    }

private:
    ElementBlockTables tables_;
    Buffer<float> shape_;
    Buffer<float> material_;
};

}  // namespace

std::unique_ptr<BlockRows> Tetrahedra::make_block_rows(const BlockList& list) {
    return std::make_unique<TetrahedronBlocks>(*this, list);
}

}  // namespace weft
