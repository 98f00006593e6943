#pragma once

#include <vector>

#include "runtime/launch.h"
#include "simulation/contact/pair_table.h"
#include "simulation/contact/surface_buffers.h"

namespace weft {

/// What bounds patches, as enclose_patches leaves it (kernels/contact/boxes.h).
struct PatchBounds {
    Buffer<float4>&low, &high, &slant_low, &slant_high;
};

/// What may become a pair while surfaces come no nearer to each other than by a slack, so that not
/// every substep has to look for pairs everywhere. Which substep collects what is no part of the
/// result: pairs are chosen among the candidates, in their order, by what they are in that substep.
/// kernels/contact/nearing.h says when a patch collects anew, kernels/contact/candidates.h what.
class PairCandidates {
public:
    /// strides    [model vertices] xyz: how far its anchor has come since the substep before [m], w:
    ///            by how much it may get farther than then [m]; somebody else's task writes them
    /// thickness  of contact [m]
    /// room       of rows, at the beginning, as in PairSettings
    PairCandidates(SurfaceBuffers& s, Buffer<float4>& strides, float thickness, int room);

    /// By how much nearer than they touch patches count as near [m].
    float margin() const { return most_ + spare_; }
    float spare() const { return spare_; }  ///< see kernels/contact/candidates.h [m]
    std::vector<RowTable*> tables();
    /// Of triangles at a vertex, vertices at a triangle, edges at an edge.
    PairTable& triangles() { return triangles_; }
    PairTable& vertices() { return vertices_; }
    PairTable& edges() { return edges_; }
    Buffer<int>& kept() { return kept_.table.counts(); }  ///< [patches] how many were near then
    Buffer<int>& stale() { return stale_; }               ///< [patches] 1: to be collected anew
    Buffer<float>& slacks() { return slacks_; }           ///< [patches] [m]
    /// Whatever was collected counts no more. What this gives is to be shown to the devices.
    BufferStorage& forget();

    /// In the task that makes boxes: bounds of what patches have moved.
    Launch enclose();
    /// strides: of strips [first, next); patches: [first_patch, last_patch)
    void add_enclose_accesses(Step::Adding& task, int first, int next, int first_patch,
                              int last_patch);
    /// In the task that finds patches near to each other, behind that: who has to collect anew.
    Launch check(PairTable& near, PatchBounds bounds);
    void add_check_accesses(Step::Adding& task, int first_patch, int last_patch);

private:
    SurfaceBuffers& s_;
    Buffer<float4>& strides_;
    float least_, most_, spare_;
    Buffer<float4> low_, high_;  ///< [patches] bounds of strides
    PairTable kept_;             ///< of patches: what was near when they collected
    Buffer<float>& spent_;
    Buffer<float> slacks_;
    Buffer<int> stamps_, stale_, epoch_;
    PairTable triangles_, vertices_, edges_;
};

}  // namespace weft
