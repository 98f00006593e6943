#pragma once

#include <memory>
#include <vector>

#include "runtime/step.h"
#include "simulation/model/model.h"

namespace weft {

/// Gradient and Hessian block of every vertex, by one launch per family that the model has.
class VertexDerivatives {
public:
    VertexDerivatives(Model& model, VertexItems& items);

    /// One launch per family, over the items of a phase.
    std::vector<Launch> gather(Phase phase, Buffer<float4>& positions);
    /// Only the gradients: the Hessian blocks stay as they are.
    std::vector<Launch> gather_gradients(Phase phase, Buffer<float4>& positions);
    /// What a task needs of the Hessian blocks of items [first, last) that outlive it.
    void add_hessian_accesses(Step::Adding& task, int first, int last, bool writes);
    /// [9 * items] see kernels/descent/rows.h
    Buffer<float>& sums() { return sums_; }

private:
    DerivativeTarget target(Phase phase, Buffer<float4>& positions, bool is_first);

    VertexItems& items_;
    Buffer<float> sums_;
    std::vector<std::unique_ptr<DerivativeRows>> families_;
};

}  // namespace weft
