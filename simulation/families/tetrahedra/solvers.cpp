#include "kernels/descent/tetrahedra.h"
#include "kernels/sosd/tetrahedra.h"
#include "kernels/xpbd/tetrahedra.h"
#include "simulation/families/elastic_solvers.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

Launch Tetrahedra::project(const ProjectTarget& t) {
    return launch(kernels::project_tetrahedra, elements().segments(t.phase), t.positions,
                  elements().vertices(), shape, material, *t.multipliers[0], *t.multipliers[1],
                  count(), t.inverse_h2, t.fresh);
}

std::unique_ptr<DerivativeRows> Tetrahedra::make_rows(const VertexItems& items) {
    using Rows = ElasticRows<Tetrahedra, kernels::gather_tetrahedra_kernel,
                             kernels::gather_tetrahedra_gradients_kernel>;
    return std::make_unique<Rows>(*this, items);
}

Launch Tetrahedra::energy_terms(const TermTarget& t) {
    return launch(kernels::tetrahedron_terms, t.items, t.positions, elements().vertices(), shape,
                  material, t.slots, t.terms, count());
}

std::unique_ptr<StencilSolve> Tetrahedra::make_stencils(const VertexLayout& items,
                                                        const StencilLayout::Family& chosen) const {
    using Solve = ElasticStencils<Tetrahedra, kernels::solve_tetrahedron_stencils_kernel>;
    return std::make_unique<Solve>(*this, items, chosen);
}

}  // namespace weft
