#include "kernels/descent/membranes.h"
#include "kernels/sosd/membranes.h"
#include "kernels/xpbd/membranes.h"
#include "simulation/families/elastic_solvers.h"
#include "simulation/families/membranes/membranes.h"

namespace weft {

Launch Membranes::project(const ProjectTarget& t) {
    return launch(kernels::project_membranes, elements().segments(t.phase), t.positions,
                  elements().vertices(), shape, material, *t.multipliers[0], *t.multipliers[1],
                  count(), t.inverse_h2, t.fresh);
}

std::unique_ptr<DerivativeRows> Membranes::make_rows(const VertexItems& items) {
    using Rows = ElasticRows<Membranes, kernels::gather_membranes_kernel,
                             kernels::gather_membrane_gradients_kernel>;
    return std::make_unique<Rows>(*this, items);
}

Launch Membranes::energy_terms(const TermTarget& t) {
    return launch(kernels::membrane_terms, t.items, t.positions, elements().vertices(), shape,
                  material, t.slots, t.terms, count());
}

std::unique_ptr<StencilSolve> Membranes::make_stencils(const VertexLayout& items,
                                                       const StencilLayout::Family& chosen) const {
    using Solve = ElasticStencils<Membranes, kernels::solve_membrane_stencils_kernel>;
    return std::make_unique<Solve>(*this, items, chosen);
}

}  // namespace weft
