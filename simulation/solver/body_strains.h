#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// How free solids give way to what pushes them, as wholes (kernels/contact/strains.h).
class BodyStrains {
public:
    /// Null where nothing but cloth is free. body_of: [vertices]; bodies must outlive this
    static std::unique_ptr<BodyStrains> of(Model& model, FreeBodies& bodies,
                                           const Buffer<int>& body_of);

    /// Adds up what their elements do, run by run, at these positions, those of all vertices,
    /// from where moments are,
    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<int>& origins);
    /// which needs this of a region, besides the positions.
    void add_sum_accesses(Step::Adding& task, const Region& region);

    /// [2 * lag_count] of the runs; [2 * bodies]: see solve_strains
    Buffer<float4>& virials() { return virials_; }
    /// [3 * vertices] of the elements' energy, behind sum()
    Buffer<float>& gradients() { return derivatives_.sums(); }
    Buffer<float>& stiffness() { return stiffness_; }
    void add_reads(Step::Adding& task);

private:
    BodyStrains(Model& model, FreeBodies& bodies);
    bool weigh(const Model& model, const Buffer<int>& body_of);

    FreeBodies& bodies_;
    VertexItems items_;
    VertexDerivatives derivatives_;
    int sum_count_;
    Buffer<float4> partials_;  ///< [parts * columns]
    Buffer<float4> virials_;   ///< [parts * sum_count]
    Buffer<float> stiffness_;  ///< [2 * bodies]
};

}  // namespace weft
