#pragma once

#include <vector>

#include "runtime/planning/regions.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/held_body.h"
#include "simulation/solver/moment_sums.h"

namespace weft {

/// Where held bodies are, where they should be, and what holds them, run by run, and the motions
/// that follow from that (kernels/bodies/held_bodies.h). All of it is made anew for each use.
class HeldSums {
public:
    /// bodies: one at least
    HeldSums(Model& model, const std::vector<HeldBody>& bodies);

    /// What is summed up.
    struct Place {
        Buffer<float4>& positions;  ///< [vertices]
        Buffer<float4>& targets;    ///< [vertices] x~; w: above 0 of what is pushed or touched
        Buffer<float4>* starts;     ///< [vertices] x~ before obstacles pushed; null: none do
        Buffer<float4>* now;        ///< [vertices] where pins have got to since; null: there
    };
    std::vector<Launch> sum(const Place& place);
    /// What that needs of a region, besides its own targets, and writes there.
    void add_sum_accesses(Step::Adding& task, const Region& region, const Place& place);

    /// Of all regions, for motions.
    void add_reads(Step::Adding& task);
    void add_motion_accesses(Step::Adding& task, StripRange strips);
    void add_motion_reads(Step::Adding& task);

    /// What of them is free.
    FreeBodies& bodies() { return bodies_; }
    MomentSums& moments() { return moments_; }
    Buffer<float4>& pulls() { return pulls_; }
    Buffer<int>& runs() { return runs_; }          ///< [columns] the run of each
    Buffer<int>& ends() { return ends_; }          ///< [2 * runs] see the kernels
    Buffer<float4>& hinges() { return hinges_; }   ///< [2 * runs]
    Buffer<float>& numbers() { return numbers_; }  ///< [3 * runs]
    /// [3 * (runs + 1)] Each region makes those of its own runs.
    Buffer<float4>& motions() { return motions_; }

private:
    /// Vertices [begin, end).
    struct VertexRange {
        int begin, end;
    };
    void find_seen();
    VertexRange seen_by(const Region& region) const;
    void fill_runs(const std::vector<HeldBody>& bodies);
    Launch add_pulls(const Place& place);
    void add_end_reads(Step::Adding& task, const Region& region, Buffer<float4>& positions,
                       VertexRange known);

    Model& model_;
    FreeBodies bodies_;
    MomentSums moments_;
    VertexItems items_;  ///< what is held
    VertexDerivatives derivatives_;
    FreeBodies holds_;                  ///< the same runs, of these items
    std::vector<VertexRange> seen_by_;  ///< [strips] what elements of held vertices have there
    Buffer<int> runs_;
    Buffer<int> ends_;
    Buffer<float> numbers_;
    Buffer<float4> pulls_;
    Buffer<float4> hinges_;
    Buffer<float4> motions_;
};

}  // namespace weft
