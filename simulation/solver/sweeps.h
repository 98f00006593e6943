#pragma once

#include <functional>
#include <memory>

#include "simulation/solver/derivatives.h"
#include "simulation/solver/descent.h"
#include "simulation/solver/solver.h"

namespace weft {

/// What block descent methods share: Gauss-Seidel sweeps over the vertices on strips and seams.
///
/// A substep: predict, then `iterations` sweeps, each
///   seams:  all vertices with elements between two strips, colour by colour: the elements add up
///           gradient and Hessian of each vertex, then the method solves its systems
///   strips: all vertices inside a strip likewise, then obstacles (all vertices), as in XPBD: an
///           iteration ends without penetration, and friction sees the whole iteration's slip;
///           then what contacts between bodies forbid (contact/response.h)
/// then the momentum of free bodies, where there are any, and velocities. This order is the same
/// for every number of devices: it defines the result.
class SweepSolver : public Solver {
public:
    std::vector<const TaskBody*> bodies() const override;
    std::vector<std::string> kinds() const override;
    std::vector<BufferStorage*> state() override { return substep_.state(); }
    std::vector<RowTable*> tables() override { return substep_.tables(); }
    ContactResponse* contact() override { return substep_.contact(); }
    std::vector<Buffer<float4>*> iterate() override;
    Asynchrony asynchrony() const override;
    Step make_step(const Partition& partition) override;

protected:
    explicit SweepSolver(Model& model);

    /// Adds a sweep; iteration i does number i modulo their number.
    /// solve: the launches that move vertices, over as many colours as the items have
    void add_sweep(const VertexLayout& layout,
                   const std::function<std::vector<Launch>(const SweepTarget&)>& solve);

    Model& model() { return model_; }

private:
    enum Kind { kPredict, kSeams, kStrips, kVelocities, kKinds };
    struct Sweep {
        Sweep(Model& model, const VertexLayout& layout)
            : items(layout), derivatives(model, items) {}
        VertexItems items;
        VertexDerivatives derivatives;
        TaskBody seams, strips;
    };
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration);
    void add_seams(Step& step, int iteration, StripRange strips, RegionId region);
    void add_strips(Step& step, int iteration, StripRange strips, RegionId region);
    const Sweep& sweep(int iteration) const {
        return *sweeps_[static_cast<std::size_t>(iteration) % sweeps_.size()];
    }

    Model& model_;
    DescentSubstep substep_;
    Halo halo_;
    TaskBody predict_, velocities_;
    std::vector<std::unique_ptr<Sweep>> sweeps_;
};

}  // namespace weft
