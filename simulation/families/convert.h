#pragma once

#include "kernels/platform.h"
#include "simulation/mesh/vec3.h"

namespace weft {

inline Vec3 to_vec3(const float4& v) { return {v.x, v.y, v.z}; }

inline float4 to_float4(Vec3 v, double w = 0.0) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

}  // namespace weft
