#include "simulation/solver/vbd.h"

#include "kernels/vbd/solve.h"
#include "simulation/solver/sweeps.h"

namespace weft {

namespace {

class VbdSolver final : public SweepSolver {
public:
    explicit VbdSolver(Model& model) : SweepSolver(model) {
        const VertexLayout layout = make_vertex_layout(model.stencils(), model.strips);
        add_sweep(layout, [](const SweepTarget& t) {
            return std::vector{launch(kernels::solve_vertices, t.items.segments(t.phase),
                                      t.positions, t.targets, t.items.vertices(), t.sums,
                                      t.items.count(), t.inverse_h2)};
        });
    }
};

}  // namespace

std::unique_ptr<Solver> make_vbd_solver(Model& model) { return std::make_unique<VbdSolver>(model); }

}  // namespace weft
