#pragma once

#include <memory>
#include <vector>

#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/vertex_items.h"

namespace weft {

/// What a launch that gathers slopes works on.
struct SlopeTarget {
    const Segments& segments;  ///< of the items
    Buffer<float4>& positions;
    Buffer<int>& vertices;  ///< of the items
    Buffer<float>& sums;    ///< [9 * items], see kernels/descent/rows.h
    int item_count = 0;
    int fresh = 0;  ///< 1: overwrites what stands in the sums
};

/// One family of elements, seen from the vertices: per vertex a row of what touches it.
class SlopeFamily {
public:
    virtual ~SlopeFamily() = default;
    virtual Launch gather(const SlopeTarget& target) = 0;
    /// Only the gradients.
    virtual Launch gather_forces(const SlopeTarget& target) = 0;
};

std::unique_ptr<SlopeFamily> make_spring_slopes(const Springs& springs, const VertexItems& items);
std::unique_ptr<SlopeFamily> make_membrane_slopes(const Membranes& membranes,
                                                  const VertexItems& items);
std::unique_ptr<SlopeFamily> make_tetrahedron_slopes(const Tetrahedra& tetrahedra,
                                                     const VertexItems& items);
std::unique_ptr<SlopeFamily> make_bending_slopes(const Hinges& hinges, const VertexItems& items);

/// Gradient and Hessian block of every vertex, by one launch per family that the model has.
class Slopes {
public:
    Slopes(const Model& model, VertexItems& items);

    /// One launch per family, over the items of a phase.
    std::vector<Launch> gather(Phase phase, Buffer<float4>& positions);
    /// Only the gradients: the Hessian blocks stay as they are.
    std::vector<Launch> gather_forces(Phase phase, Buffer<float4>& positions);
    /// What a task needs of the Hessian blocks of items [first, last) that outlive it.
    void add_hessian_accesses(Step::Adding& task, int first, int last, bool writes);
    Buffer<float>& sums() { return sums_; }

private:
    SlopeTarget target(Phase phase, Buffer<float4>& positions, bool is_first);

    VertexItems& items_;
    Buffer<float> sums_;
    std::vector<std::unique_ptr<SlopeFamily>> families_;
};

/// All elements of the model, in new vertices: who touches whom.
std::vector<Stencils> all_stencils(const Model& model);

}  // namespace weft
