#include "kernels/descent/springs.h"
#include "kernels/sosd/springs.h"
#include "kernels/xpbd/springs.h"
#include "simulation/families/element_rows.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/stencil_tables.h"

namespace weft {

namespace {

class SpringRows final : public DerivativeRows {
public:
    SpringRows(const Springs& springs, const VertexItems& items)
        : rows_("springs", springs.elements(), items),
          material_("springs.row_material", 2 * rows_.entries()) {
        rows_.fill(material_, [&](int spring, int) {
            return FewNumbers{springs.rest_length(spring), springs.stiffness(spring)};
        });
        rows_.filled();
    }

    Launch gather(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_springs, t);
    }
    Launch gather_gradients(const DerivativeTarget& t) override {
        return launch_over_rows(kernels::gather_spring_gradients, t);
    }

private:
    template <class Kernel>
    Launch launch_over_rows(Kernel kernel, const DerivativeTarget& t) {
        return launch(kernel, t.segments, t.positions, t.vertices, rows_.slices(), rows_.others(),
                      material_, t.sums, t.item_count, rows_.entry_count(), SlicedRows::kStride,
                      t.fresh);
    }

    ElementRows rows_;
    Buffer<float> material_;
};

class SpringStencils final : public StencilSolve {
public:
    SpringStencils(const Springs& springs, const VertexLayout& items,
                   const StencilLayout::Family& chosen)
        : tables_(items, chosen), material_("stencils.material", 2 * chosen.elements.size()) {
        const std::size_t count = chosen.elements.size();
        for (std::size_t i = 0; i < count; ++i) {
            material_[i] = static_cast<float>(springs.rest_length(chosen.elements[i]));
            material_[count + i] = static_cast<float>(springs.stiffness(chosen.elements[i]));
        }
    }
    Launch solve(const SweepTarget& t) override {
        return tables_.launch_over(kernels::solve_spring_stencils, t, material_);
    }

private:
    StencilTables tables_;
    Buffer<float> material_;
};

}  // namespace

Launch Springs::project(const ProjectTarget& t) {
    return launch(kernels::project_springs, elements().segments(t.phase), t.positions,
                  elements().vertices(), material, *t.multipliers[0], count(), t.inverse_h2,
                  t.fresh);
}

std::unique_ptr<DerivativeRows> Springs::make_rows(const VertexItems& items) {
    return std::make_unique<SpringRows>(*this, items);
}

Launch Springs::energy_terms(const TermTarget& t) {
    return launch(kernels::spring_terms, t.items, t.positions, elements().vertices(), material,
                  t.slots, t.terms, count());
}

std::unique_ptr<StencilSolve> Springs::make_stencils(const VertexLayout& items,
                                                     const StencilLayout::Family& chosen) const {
    return std::make_unique<SpringStencils>(*this, items, chosen);
}

}  // namespace weft
