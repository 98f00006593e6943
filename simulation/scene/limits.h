#pragma once

#include <cstdint>

namespace weft {

/// Most vertices a scene may have. Indices of everything built on them (corners of triangles, four
/// vertices per bending hinge, three numbers per position) must fit an int32 in the kernels.
constexpr std::int64_t kMaxVertices = 20'000'000;

}  // namespace weft
