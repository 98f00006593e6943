#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "simulation/mesh/box_tree.h"

namespace weft {

/// Triangles in space. Positions are numbers of single precision.
struct PlainSurface {
    std::span<const Vec3> positions;
    std::span<const std::array<int, 3>> triangles;

    Vec3 corner(int triangle, std::size_t k) const {
        const auto& t = triangles[static_cast<std::size_t>(triangle)];
        return positions[static_cast<std::size_t>(t[k])];
    }
    Bounds bounds(int triangle) const;
    BoxTree tree() const;
};

using TrianglePair = std::array<int, 2>;

/// All pairs (low, high) of triangles of which an edge of the one goes through the other,
/// ascending.
///
/// Exact: no rounding hides a crossing or makes one. What only touches does not cross: an edge or a
/// vertex that lies on a surface and stays on one side of it, two surfaces in one plane, all that
/// happens at a border. Where it passes exactly through an edge or a vertex inside a surface, or a
/// vertex lies exactly in it, the neighbours tell whether it gets to the other side. An edge and a
/// triangle with a common vertex never count.
/// counts(a, b)  whether that pair is asked for
std::vector<TrianglePair> find_crossings(const PlainSurface& surface, const BoxTree& tree,
                                         const std::function<bool(int, int)>& counts);

}  // namespace weft
