#pragma once

#include <array>
#include <memory>
#include <vector>

#include "runtime/launch.h"
#include "simulation/topology/vertex_layout.h"

namespace weft {

/// The vertices as items of a solver's kernels.
class VertexItems {
public:
    /// By phase and colour, for solvers in which a vertex sees what its neighbours just did.
    explicit VertexItems(const VertexLayout& layout);
    /// Item v is vertex v, strip by strip, for solvers in which all vertices move at once.
    explicit VertexItems(const Strips& strips);

    /// Some vertices, each once.
    VertexItems(const Strips& strips, std::vector<int> vertices);

    /// Of the model; there may be fewer items.
    int vertex_count() const { return vertex_count_; }
    int count() const { return static_cast<int>(vertices_.count()); }
    int vertex(int item) const { return vertices_[static_cast<std::size_t>(item)]; }
    std::span<const int> segment_begin() const { return segment_begin_.span(); }

    Buffer<int>& vertices() { return vertices_; }
    /// The items of a phase. Without colours, all are in the inner phase.
    const Segments& segments(Phase phase) const { return segments_[phase]; }

private:
    int vertex_count_;
    Buffer<int> vertices_;
    Buffer<int> segment_begin_;
    std::array<Segments, kPhaseCount> segments_;
};

}  // namespace weft
