#pragma once

#include <vector>

#include "simulation/solver/moment_sums.h"

namespace weft {

/// Free bodies in scenes without contact: each is shifted and turned by what is missing of its
/// momentum (kernels/bodies/free_bodies.h).
class LoneBodies {
public:
    /// bodies must outlive this. held: as in missing_motion (kernels/bodies/free_bodies.h)
    LoneBodies(FreeBodies& bodies, float held);

    /// Adds up what is missing, behind the last iteration of all regions.
    MomentSums& sums() { return sums_; }

    /// Moves the vertices of a region's strips then.
    /// deviations  [vertices] x - x~
    std::vector<Launch> move(Model& model, Buffer<float4>& deviations);
    void add_move_accesses(Step::Adding& task) { sums_.add_reads(task); }

private:
    FreeBodies& bodies_;
    float held_;
    MomentSums sums_;
    Buffer<float4> motions_;  ///< [3 * (runs + 1)] each region makes those of its own runs
};

}  // namespace weft
