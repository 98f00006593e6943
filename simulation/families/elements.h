#pragma once

#include <string>

#include "runtime/launch.h"
#include "simulation/topology/layout.h"

namespace weft {

/// The elements of one kind as kernels want them: sorted by (phase, strip, colour), column-major.
class Elements {
public:
    Elements(const std::string& name, const Stencils& stencils, const Strips& strips);

    int count() const { return layout_.stencils.count(); }
    int arity() const { return layout_.stencils.arity; }
    /// All of them, in the new order of vertices.
    const Stencils& stencils() const { return layout_.stencils; }
    /// The vertices of an element, in the new order of vertices.
    std::span<const int> vertices_of(int element) const { return layout_.stencils[element]; }
    /// New element -> element as it was given.
    int original(int element) const { return layout_.order[static_cast<std::size_t>(element)]; }

    /// [arity * count] column-major
    Buffer<int>& vertices() { return vertices_; }
    const Buffer<int>& vertices() const { return vertices_; }
    /// The elements of a phase.
    const Segments& segments(Phase phase) const { return segments_[phase]; }

private:
    ElementLayout layout_;
    Buffer<int> vertices_;
    Buffer<int> segment_begin_;
    std::array<Segments, kPhaseCount> segments_;
};

}  // namespace weft
