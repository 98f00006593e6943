#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/mesh/triangle_mesh.h"

namespace weft {

/// Lengths, areas and folds of a mesh at rest, where its triangles may have been cut apart.
class RestShape {
public:
    /// The mesh must outlive it.
    explicit RestShape(const TriangleMesh& mesh);

    /// Of the edge between two vertices [m]; the mean where its triangles disagree.
    double length_of(int a, int b) const;
    /// Of a triangle [m^2].
    double area_of(std::size_t triangle) const;
    /// The corners of a hinge (see Adjacency) as they lie to each other [m]: as they are where both
    /// triangles have the edge in one place, otherwise (a seam between panels) laid flat, with
    /// each triangle's own shape.
    std::array<Vec3, 4> hinge(std::span<const int> corners) const;

private:
    /// One side of a triangle whose rest shape is its own.
    struct Side {
        int low, high;  ///< vertices
        int opposite;
        std::size_t triangle;
    };

    std::span<const Side> sides_of(int a, int b) const;
    Vec3 corner_of(std::size_t triangle, int vertex) const;
    Vec3 position(int vertex) const { return mesh_.positions[static_cast<std::size_t>(vertex)]; }

    const TriangleMesh& mesh_;
    std::vector<Side> sides_;  ///< sorted by their vertices; empty where `positions` is at rest
};

}  // namespace weft
