#pragma once

#include <span>
#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

struct StripOptions {
    int target_strips = 32;             ///< aimed at, where the mesh is long and large enough
    int min_vertices_per_strip = 64;    ///< never fewer, unless the mesh has fewer
    int max_vertices_per_strip = 8000;  ///< where they would be larger on average: aim at more
    /// 0: the two seams of one strip share no vertex. k: nor does a chain of k elements connect
    /// them. Vertex-wise solvers need 1: there, vertices of different seams must not be neighbours.
    int extra_levels = 0;
};

/// The order of all vertices and its cuts into strips.
///
/// Invariants, for every kind of element that took part:
/// - an element touches one strip, or two neighbouring strips (then it belongs to the seam between
///   them); never three;
/// - hulls of different seams are disjoint, and seam s lies within strips s and s+1.
/// So all strips' inner elements are independent of each other, and all seams are.
///
/// Vertices of one connected component are contiguous, and components are ordered by their lowest
/// old vertex. So a body (a range of old vertices with no element to other bodies) keeps its range.
/// The result depends on the mesh and the options only.
struct Strips {
    std::vector<int> order;  ///< [vertex_count] new vertex -> old vertex
    std::vector<int> rank;   ///< [vertex_count] old vertex -> new vertex
    std::vector<int> begin;  ///< [count() + 1] strip s = new vertices [begin[s], begin[s + 1])
    /// [seam_count()] seam s, between strips s and s + 1: the contiguous hull [seam_begin[s],
    /// seam_end[s]) of the new vertices that its elements touch. No elements: both = begin[s + 1].
    std::vector<int> seam_begin;
    std::vector<int> seam_end;

    int count() const { return static_cast<int>(begin.size()) - 1; }
    int seam_count() const { return static_cast<int>(seam_begin.size()); }
    /// The strip of a new vertex.
    int strip_of(int vertex) const;
};

/// Orders each component by breadth-first levels from a pseudo-peripheral vertex and cuts the order
/// at level boundaries into strips of about equal work. Small components share a strip; one that is
/// short in levels is not cut at all. No vertices: no strips.
/// kinds  every kind of element whose vertices are written; vertices in [0, vertex_count)
Strips make_strips(int vertex_count, std::span<const Stencils> kinds,
                   const StripOptions& options = {});

}  // namespace weft
