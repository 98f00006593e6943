#pragma once

// For the sources that evaluate element functions in double precision; to be included first.

#ifndef WEFT_IN_DOUBLE
#define WEFT_IN_DOUBLE
#endif

#include "kernels/matrix.h"
#include "kernels/vector.h"
#include "simulation/mesh/vec3.h"

namespace weft {

inline kernels::real3 to_real3(Vec3 v) { return kernels::make3(v.x, v.y, v.z); }
inline Vec3 to_vec3(kernels::real3 v) { return {v.x, v.y, v.z}; }
inline Mat3 to_mat3(kernels::sym3 a) {
    return {{Vec3{a.xx, a.xy, a.xz}, Vec3{a.xy, a.yy, a.yz}, Vec3{a.xz, a.yz, a.zz}}};
}

inline Mat3 to_mat3(kernels::mat3 a) {
    return transposed({{to_vec3(a.x), to_vec3(a.y), to_vec3(a.z)}});
}

}  // namespace weft
