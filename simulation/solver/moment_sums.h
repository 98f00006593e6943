#pragma once

#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// Adds up, run by run, where the mass of free bodies is and where it should be
/// (kernels/bodies/moments.h).
class MomentSums {
public:
    /// bodies must outlive this. may_be_pushed: by obstacles; where not, sum() is told of no starts
    explicit MomentSums(FreeBodies& bodies, bool may_be_pushed = true);

    /// starts: [vertices] x~ before obstacles pushed; null: there are none
    std::vector<Launch> sum(Model& model, Buffer<float4>& positions, Buffer<float4>& targets,
                            Buffer<float4>* starts);
    /// What that needs of a region, besides its own positions and targets,
    void add_sum_accesses(Step::Adding& task, const Region& region, Buffer<float4>* starts);
    /// and of others: the vertex that a body is seen from may lie there.
    void add_origin_reads(Step::Adding& task, const Region& region, Buffer<float4>& positions);

    /// [columns], [9 * (runs + most_runs)] see the kernels
    Buffer<int>& origins() { return origins_; }
    /// [7 * columns] and more, scratch behind sum(): for other sums over the same columns.
    Buffer<float4>& partials() { return partials_; }
    Buffer<float4>& sums() { return sums_; }
    void add_reads(Step::Adding& task);

private:
    FreeBodies& bodies_;
    Model* model_ = nullptr;  ///< behind sum()
    Buffer<int> origins_;
    Buffer<float4> partials_;
    Buffer<float4> sums_;
};

}  // namespace weft
