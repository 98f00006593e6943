#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/mesh/vec3.h"
#include "simulation/topology/strips.h"

namespace weft {

/// What a surface is made of, in the model's vertices.
struct SurfaceMesh {
    std::vector<std::array<int, 3>> triangles;  ///< as oriented in their mesh
    std::vector<int> triangle_body;             ///< [triangles]
    std::vector<Vec3> rest;                     ///< [model vertices] [m]
    std::vector<char> held;                     ///< [model vertices] what cannot be moved
    /// [model vertices] a number in common: they count as one vertex, which does not touch itself
    std::vector<int> knots;
};

/// Lists of ints: list i is items[begin[i]] to items[begin[i + 1]].
struct Lists {
    std::vector<int> begin{0};
    std::vector<int> items;

    std::span<const int> operator[](int list) const {
        const auto i = static_cast<std::size_t>(list);
        return {items.data() + begin[i], items.data() + begin[i + 1]};
    }
    int count() const { return static_cast<int>(begin.size()) - 1; }
    void close() { begin.push_back(static_cast<int>(items.size())); }
};

/// All that can touch: triangles, their edges and their vertices, by strips and, within, by
/// patches: some 8 vertices near each other at rest, of one body, with the triangles and edges
/// whose lowest vertex they are. A patch's triangles reach no further than into the next strip.
///
/// Numbers of vertices, triangles and edges are those of the surface; `vertices` leads to the
/// model's. This order is part of the result, and depends on meshes and strips alone.
struct Surface {
    static constexpr int kPatchVertices = 8;

    std::vector<int> vertices;                  ///< the model's
    std::vector<int> knots;                     ///< [vertices] as in SurfaceMesh
    std::vector<std::array<int, 3>> triangles;  ///< as oriented in their mesh
    std::vector<std::array<int, 2>> edges;      ///< lower vertex, higher vertex
    std::vector<int> mesh_triangles;            ///< [triangles] their numbers in the mesh

    /// [patches + 1] the items of a patch
    std::vector<int> patch_vertices, patch_triangles, patch_edges;
    std::vector<int> patch_body;   ///< [patches]
    std::vector<char> patch_held;  ///< [patches] whether nothing of it can be moved
    /// By how much the border turns inward at the vertices of each patch's faces, all together
    /// [rad] (notches.h).
    std::vector<double> turns;  ///< [patches]
    /// Patches that a patch hangs together with, itself too, where there is no slit between them:
    /// as PatchGroups::beside.
    Lists beside;
    std::vector<int> between;  ///< [entries of beside] the patch between; one of the two if none is
    /// Of a patch: its triangles, and one each of the vertices and edges that are in none of them:
    /// so where all faces are flat, all of it is.
    Lists faces;
    Lists rims;                      ///< the vertices of these faces, each once, ascending
    Lists hulls;                     ///< all vertices of a patch's triangles and its own, ascending
    std::vector<int> strip_patches;  ///< [strips + 1] the patches of a strip

    Lists triangles_at;  ///< of a vertex, ascending
    Lists edges_at;      ///< likewise
    Lists around;        ///< the patches that a patch' vertices belong to, ascending
    Lists patches_at;    ///< those in whose hulls it is, ascending
    Lists ring;          ///< the vertices that share an edge with a vertex, ascending
    /// [triangles] beyond the edge that is opposite to a corner: the vertex of the other triangle
    /// there; -1: there is none
    std::vector<std::array<int, 3>> beyond;
    /// [triangles] bit k: the lowest triangle at the edge opposite to corner k; bit 3 + k: at
    /// corner k. So what several triangles share counts once.
    std::vector<int> owned;

    int vertex_count() const { return static_cast<int>(vertices.size()); }
    int triangle_count() const { return static_cast<int>(triangles.size()); }
    int edge_count() const { return static_cast<int>(edges.size()); }
    int patch_count() const { return static_cast<int>(patch_body.size()); }
    int strip_count() const { return static_cast<int>(strip_patches.size()) - 1; }
};

/// Triangles that name a vertex twice are passed over.
Surface make_surface(const SurfaceMesh& mesh, const Strips& strips);

}  // namespace weft
