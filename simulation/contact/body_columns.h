#pragma once

#include "runtime/launch.h"

namespace weft {

/// In which order the vertices of free bodies are summed up: see kernels/bodies/runs.h.
struct BodyColumns {
    Buffer<int>& members;
    Buffer<float>& shares;
    Buffer<int>& rows;
    const Segments& by_strip;  ///< the columns of each strip
    int count;                 ///< of columns
};

}  // namespace weft
