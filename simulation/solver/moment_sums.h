#pragma once

#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// Adds up, run by run, where the mass of free bodies is and where it should be
/// (kernels/bodies/moments.h).
class MomentSums {
public:
    /// bodies must outlive this.
    explicit MomentSums(FreeBodies& bodies);

    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<float4>& targets);
    /// What that needs of a region, besides its own positions and targets,
    void add_sum_accesses(Step::Adding& task, const Region& region);
    /// and of others: the vertex that a body is seen from may lie there.
    void add_origin_reads(Step::Adding& task, const Region& region, Buffer<float4>& positions);

    /// [columns], [7 * (runs + most_runs)] see the kernels
    Buffer<int>& origins() { return origins_; }
    Buffer<float4>& sums() { return sums_; }
    void add_reads(Step::Adding& task);

private:
    FreeBodies& bodies_;
    Buffer<int> origins_;
    Buffer<float4> partials_;  ///< [7 * columns]
    Buffer<float4> sums_;
};

}  // namespace weft
