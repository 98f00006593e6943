#pragma once

#include <span>

#include "simulation/topology/stencils.h"

namespace weft {

/// The edges and hinges of a triangle mesh.
struct Adjacency {
    /// Arity 2: every edge once as (low, high), sorted by (low, high).
    Stencils edges;
    /// Arity 4: x0, x1 = shared edge with x0 < x1; x2, x3 = the vertices opposite to it. x2 belongs
    /// to the triangle that runs through the edge from x0 to x1, x3 to the one that runs from x1 to
    /// x0. Where two triangles disagree about the orientation, x2 is of the one with the lower
    /// index. One hinge per edge with exactly two triangles, sorted like the edges.
    Stencils hinges;
};

/// Finds edges and hinges.
/// triangles  [3 * triangle_count] vertices in [0, vertex_count)
/// Edges with one triangle (borders) and with more than two (non-manifold) have no hinge. Triangles
/// that name a vertex twice are passed over; so are hinges between two copies of one triangle.
Adjacency find_adjacency(int vertex_count, std::span<const int> triangles);

}  // namespace weft
