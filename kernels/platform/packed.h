#pragma once

#include <bit>
#include <cmath>
#include <cstring>

#include "kernels/platform/types.h"

// WEFT_PACKED_TARGET is `packed` or `packed_avx2`; which instructions the 8 lanes become is the
// business of the compiler's flags. See kernels/CMakeLists.txt.
#define WEFT_TARGET WEFT_PACKED_TARGET
#define WEFT_REGISTER(kernel) register_packed<kernel>(WEFT_PACKED_ID)
#define WEFT_REGISTRATION(name) \
    inline const bool name##_is_registered = WEFT_REGISTER(name##_kernel);

WEFT_KERNELS_BEGIN

inline constexpr int kLanes = 8;

typedef float real __attribute__((vector_size(32)));
typedef int integer __attribute__((vector_size(32)));
typedef float quad __attribute__((vector_size(16)));

struct real4 {
    real x, y, z, w;
};

struct item {
    int first;
    int count;
};

WEFT_INLINE real splat(float value) {
    return real{value, value, value, value, value, value, value, value};
}

WEFT_INLINE real square_root(real value) {
    real root;
    for (int lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(value[lane]);
    return root;
}

WEFT_INLINE item column(item i, int rows, int k) { return {i.first + rows * k, i.count}; }

template <class Vector, class T>
WEFT_INLINE Vector load_lanes(const T* p, item i) {
    Vector v;
    if (i.count == kLanes) {
        std::memcpy(&v, p + i.first, sizeof v);
    } else {
        for (int lane = 0; lane < kLanes; ++lane) {
            v[lane] = p[i.first + (lane < i.count ? lane : i.count - 1)];
        }
    }
    return v;
}

WEFT_INLINE real load(const float* p, item i) { return load_lanes<real>(p, i); }
WEFT_INLINE integer load_index(const int* p, item i) { return load_lanes<integer>(p, i); }

WEFT_INLINE void store(float* p, item i, real v) {
    if (i.count == kLanes) {
        std::memcpy(p + i.first, &v, sizeof v);
    } else {
        for (int lane = 0; lane < i.count; ++lane) p[i.first + lane] = v[lane];
    }
}

WEFT_INLINE quad load_quad(const float4* p) {
    quad v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

/// Reads 8 rows of 4 and turns them into 4 columns of 8, in pairs of 128-bit halves.
WEFT_INLINE real4 gather4(const float4* p, integer k) {
    real rows[4];  // rows[j]: p[k[j]] in the lower half, p[k[j + 4]] in the upper
    for (int j = 0; j < 4; ++j) {
        rows[j] = __builtin_shufflevector(load_quad(p + k[j]), load_quad(p + k[j + 4]), 0, 1, 2, 3,
                                          4, 5, 6, 7);
    }
    const real xy01 = __builtin_shufflevector(rows[0], rows[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const real xy23 = __builtin_shufflevector(rows[2], rows[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const real zw01 = __builtin_shufflevector(rows[0], rows[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const real zw23 = __builtin_shufflevector(rows[2], rows[3], 2, 10, 3, 11, 6, 14, 7, 15);
    return {__builtin_shufflevector(xy01, xy23, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(xy01, xy23, 2, 3, 10, 11, 6, 7, 14, 15),
            __builtin_shufflevector(zw01, zw23, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(zw01, zw23, 2, 3, 10, 11, 6, 7, 14, 15)};
}

/// The way back.
WEFT_INLINE void scatter4(float4* p, integer k, real4 v) {
    const real xy01 = __builtin_shufflevector(v.x, v.y, 0, 8, 1, 9, 4, 12, 5, 13);
    const real xy23 = __builtin_shufflevector(v.x, v.y, 2, 10, 3, 11, 6, 14, 7, 15);
    const real zw01 = __builtin_shufflevector(v.z, v.w, 0, 8, 1, 9, 4, 12, 5, 13);
    const real zw23 = __builtin_shufflevector(v.z, v.w, 2, 10, 3, 11, 6, 14, 7, 15);
    const real rows[4] = {__builtin_shufflevector(xy01, zw01, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(xy01, zw01, 2, 3, 10, 11, 6, 7, 14, 15),
                          __builtin_shufflevector(xy23, zw23, 0, 1, 8, 9, 4, 5, 12, 13),
                          __builtin_shufflevector(xy23, zw23, 2, 3, 10, 11, 6, 7, 14, 15)};
    for (int j = 0; j < 4; ++j) {
        std::memcpy(p + k[j], &rows[j], sizeof(float4));
        std::memcpy(p + k[j + 4], reinterpret_cast<const char*>(&rows[j]) + sizeof(float4),
                    sizeof(float4));
    }
}

WEFT_INLINE integer lane_indices(item i) {
    const integer lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    const integer last = integer{} + (i.count - 1);
    return (lanes < last ? lanes : last) + i.first;
}

WEFT_INLINE real4 load4(const float4* p, item i) { return gather4(p, lane_indices(i)); }
WEFT_INLINE void store4(float4* p, item i, real4 v) { scatter4(p, lane_indices(i), v); }

WEFT_KERNELS_END
