#include "kernels/descent/woven.h"
#include "kernels/sosd/woven.h"
#include "kernels/xpbd/woven.h"
#include "simulation/families/elastic_solvers.h"
#include "simulation/families/woven/woven.h"

namespace weft {

Launch WovenCloth::project(const ProjectTarget& t) {
    return launch(kernels::project_woven, elements().segments(t.phase), t.positions,
                  elements().vertices(), shape, material, *t.multipliers[0], *t.multipliers[1],
                  *t.multipliers[2], count(), t.inverse_h2, t.fresh);
}

std::unique_ptr<DerivativeRows> WovenCloth::make_rows(const VertexItems& items) {
    using Rows = ElasticRows<WovenCloth, kernels::gather_woven_kernel,
                             kernels::gather_woven_gradients_kernel>;
    return std::make_unique<Rows>(*this, items);
}

Launch WovenCloth::energy_terms(const TermTarget& t) {
    return launch(kernels::woven_terms, t.items, t.positions, elements().vertices(), shape,
                  material, t.slots, t.terms, count());
}

std::unique_ptr<StencilSolve> WovenCloth::make_stencils(const VertexLayout& items,
                                                        const StencilLayout::Family& chosen) const {
    using Solve = ElasticStencils<WovenCloth, kernels::solve_woven_stencils_kernel>;
    return std::make_unique<Solve>(*this, items, chosen);
}

}  // namespace weft
