#pragma once

#include "simulation/families/element_rows.h"
#include "simulation/families/stencil_tables.h"

namespace weft {

/// How solvers see elements with a shape at rest and a material. Family has the tables
///   shape     [columns * count] column-major: the gradients b_1 ... of the corners' barycentric
///             coordinates [1/m]; b_0 balances them
///   material  [columns * count] column-major, times the size at rest
/// and says shape_gradient(element, corner): b of a corner, as numbers.

/// Rows for kernels that take the tables others, shape and material.
template <class Family, class Kernel, class GradientKernel>
class ElasticRows final : public DerivativeRows {
public:
    ElasticRows(const Family& family, const VertexItems& items)
        : rows_(family.names().name, family.elements(), items),
          shape_(family.names().name + ".row_shape",
                 rows_.others().count() * family.shape_gradient(0, 0).size()),
          material_(family.names().name + ".row_material",
                    rows_.entries() * columns_of(family.material, family)) {
        rows_.fill(shape_, [&](int element, int corner) {
            FewNumbers numbers;
            for (int o = 1; o < family.elements().arity(); ++o) {
                const int other = (corner + o) % family.elements().arity();
                for (const double b : family.shape_gradient(element, other)) numbers.push_back(b);
            }
            return numbers;
        });
        rows_.fill(material_, [&](int element, int) {
            FewNumbers numbers;
            for (std::size_t c = 0; c < columns_of(family.material, family); ++c) {
                numbers.push_back(column(family.material, c, family, element));
            }
            return numbers;
        });
        rows_.filled();
    }

    Launch gather(const DerivativeTarget& t) override { return launch_over_rows(Kernel{}, t); }
    Launch gather_gradients(const DerivativeTarget& t) override {
        return launch_over_rows(GradientKernel{}, t);
    }

private:
    template <class AnyKernel>
    Launch launch_over_rows(AnyKernel kernel, const DerivativeTarget& t) {
        return launch(kernel, t.segments, t.positions, t.vertices, rows_.slices(), rows_.others(),
                      shape_, material_, t.sums, t.item_count, rows_.entry_count(),
                      SlicedRows::kStride, t.fresh);
    }
    static std::size_t columns_of(const Buffer<float>& table, const Family& family) {
        return table.count() / static_cast<std::size_t>(family.count());
    }
    static double column(const Buffer<float>& table, std::size_t c, const Family& family, int e) {
        const auto count = static_cast<std::size_t>(family.count());
        return static_cast<double>(table[c * count + static_cast<std::size_t>(e)]);
    }

    ElementRows rows_;
    Buffer<float> shape_;
    Buffer<float> material_;
};

/// Stencils for kernels that take the tables shape and material.
template <class Family, class Kernel>
class ElasticStencils final : public StencilSolve {
public:
    ElasticStencils(const Family& family, const VertexLayout& items,
                    const StencilLayout::Family& chosen)
        : tables_(items, chosen),
          shape_("stencils.shape", size(family, family.shape, chosen)),
          material_("stencils.material", size(family, family.material, chosen)) {
        copy_rows(family.shape, family.count(), chosen.elements, shape_);
        copy_rows(family.material, family.count(), chosen.elements, material_);
    }
    Launch solve(const SweepTarget& t) override {
        return tables_.launch_over(Kernel{}, t, shape_, material_);
    }

private:
    static std::size_t size(const Family& family, const Buffer<float>& table,
                            const StencilLayout::Family& chosen) {
        return table.count() / static_cast<std::size_t>(family.count()) * chosen.elements.size();
    }

    StencilTables tables_;
    Buffer<float> shape_;
    Buffer<float> material_;
};

}  // namespace weft
