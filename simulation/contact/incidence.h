#pragma once

#include "runtime/buffer.h"
#include "simulation/contact/surface.h"

namespace weft {

/// The surface as rows of contacts want it, in the model's vertices.
struct SurfaceIncidence {
    explicit SurfaceIncidence(const Surface& surface);
    Buffer<int> apexes;  ///< [surface vertices] the model's
    Buffer<int> triangle_begin, triangle_list, edge_begin, edge_list;
    Buffer<int> triangles;  ///< [3 * triangles] column-major
    Buffer<int> edges;      ///< [2 * edges] likewise
};

}  // namespace weft
