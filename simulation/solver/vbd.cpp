#include "simulation/solver/vbd.h"

#include "kernels/vbd/solve.h"
#include "simulation/solver/sweeps.h"

namespace weft {

namespace {

class VbdSolver final : public SweepSolver {
public:
    explicit VbdSolver(Model& model) : SweepSolver(model) {
        add_sweep(make_vertex_layout(all_stencils(model), model.strips), [&](const Gathered& g) {
            return launch(kernels::solve_vertices, g.items.segments(g.phase), *model.positions,
                          g.targets, g.items.vertices(), g.sums, g.items.count(), g.inverse_h2);
        });
    }
};

}  // namespace

std::unique_ptr<Solver> make_vbd_solver(Model& model) { return std::make_unique<VbdSolver>(model); }

}  // namespace weft
