#pragma once

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// Where the mass of free bodies is and where it should be, as their motions want it
/// (kernels/contact/moments.h).
class BodyMoments {
public:
    /// bodies must outlive this. first_run, counts: [bodies] of each one's runs
    BodyMoments(FreeBodies& bodies, Buffer<int>& first_run, Buffer<float>& counts);

    /// Adds them up, run by run, at these positions, those of all vertices,
    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<float4>& targets);
    /// which needs this of a region, besides the positions and the targets;
    void add_sum_accesses(Step::Adding& task, const Region& region);
    /// and then body by body. all: the bodies
    Launch weigh(const Segments& all);
    void add_weigh_accesses(Step::Adding& task);

    /// [columns], [6 * (bodies + 1)] see the kernels
    Buffer<int>& origins() { return origins_; }
    Buffer<float4>& moments() { return moments_; }
    void add_reads(Step::Adding& task);

private:
    FreeBodies& bodies_;
    Buffer<int>& first_run_;
    Buffer<float>& counts_;
    int sum_count_;
    Buffer<int> origins_;      ///< [columns]
    Buffer<float4> partials_;  ///< [parts * columns]
    Buffer<float4> sums_;      ///< [parts * sum_count]
    Buffer<float4> moments_;
};

}  // namespace weft
