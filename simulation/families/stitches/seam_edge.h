#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/families/builder.h"

namespace weft {

/// One of the two edges that a seam joins.
struct SeamEdge {
    std::vector<int> vertices;  ///< in scene order
    /// [vertices] how far along each is, in parts of the whole length at rest, from 0 to 1 (of a
    /// loop, below 1). Empty: the vertices are listed by the author, and joined one by one.
    std::vector<double> places;
    bool is_closed = false;
};

/// The edge that one side of a seam selects of a cloth. Throws UserError where that is no border,
/// or several pieces of it. name: "a" or "b"
SeamEdge find_seam_edge(const Seam& seam, const SeamSide& side, const char* name,
                        const ClothPart& part);

/// The vertices that the seam stitches together, each of both edges at least once: those at the
/// nearest places along their edges, which run in the direction (loops: from the vertex) in which
/// they are nearest to each other at the start. Throws UserError where the edges do not fit.
/// positions  [vertices] at time 0, scene order [m]
std::vector<std::array<int, 2>> find_stitches(const Seam& seam, const SeamEdge& a,
                                              const SeamEdge& b, std::span<const Vec3> positions);

}  // namespace weft
