#pragma once

#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/free_bodies.h"

namespace weft {

/// What is done with a solid while obstacles push it. (Cloth is shifted then: what hangs from what
/// it drapes over would turn it.)
enum class PushedSolids {
    kTurned,   ///< round what friction holds of it (kernels/bodies/holding.h)
    kShifted,  ///< by xpbd, whose bodies turn by themselves
};

/// What obstacles do to vertices in a substep, as far as bodies go by it.
struct ObstaclePushes {
    Buffer<float4>* starts = nullptr;    ///< [vertices] x~ before; null: there are no obstacles
    Buffer<float4>* pressing = nullptr;  ///< [vertices] (kernels/obstacles/contact.h); null: no
                                         ///< body is turned
};

/// Adds up, run by run, where the mass of free bodies is and where it should be
/// (kernels/bodies/moments.h).
class MomentSums {
public:
    /// bodies must outlive this.
    MomentSums(FreeBodies& bodies, PushedSolids solids);

    std::vector<Launch> sum(Model& model, Buffer<float4>& positions, Buffer<float4>& targets,
                            const ObstaclePushes& pushes);
    /// What that needs of a region, besides its own positions and targets,
    void add_sum_accesses(Step::Adding& task, const Region& region);
    /// and of others: the vertex that a body is seen from may lie there.
    void add_origin_reads(Step::Adding& task, const Region& region, Buffer<float4>& positions);

    /// [columns], [13 * (runs + most_runs)] see the kernels
    Buffer<int>& origins() { return origins_; }
    Buffer<float4>& sums() { return sums_; }
    void add_reads(Step::Adding& task);

private:
    FreeBodies& bodies_;
    Model* model_ = nullptr;  ///< behind sum(), as are
    ObstaclePushes pushes_;   ///< those
    Buffer<int> origins_;
    Buffer<float> firm_;       ///< [columns]
    Buffer<float4> partials_;  ///< [13 * columns]
    Buffer<float4> sums_;
};

}  // namespace weft
