#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#ifdef __AVX__
#include <immintrin.h>
#endif

#include "kernels/platform/types.h"

// WEFT_PACKED_TARGET is `packed`, `packed_avx2` or `packed_avx512`, WEFT_PACKED_LANES 8 or 16;
// which instructions the lanes become is the business of the compiler's flags. See
// cmake/WeftKernels.cmake.
#define WEFT_TARGET WEFT_PACKED_TARGET
#define WEFT_REGISTER(kernel) register_packed<kernel>(WEFT_PACKED_ID)
#define WEFT_REGISTRATION(name) \
    inline const bool name##_is_registered = WEFT_REGISTER(name##_kernel);
#if WEFT_PACKED_LANES == 8
#define WEFT_NARROW_REGISTRATION WEFT_REGISTRATION
#else
#define WEFT_NARROW_REGISTRATION(name)
#endif

WEFT_KERNELS_BEGIN

inline constexpr int kLanes = WEFT_PACKED_LANES;

typedef float real __attribute__((vector_size(4 * kLanes)));
typedef int integer __attribute__((vector_size(4 * kLanes)));
typedef float quad __attribute__((vector_size(16)));

struct real4 {
    real x, y, z, w;
};

struct item {
    int first;
    int count;
};

template <int... Lane>
WEFT_INLINE real splat(float value, std::integer_sequence<int, Lane...>) {
    return real{(static_cast<void>(Lane), value)...};
}

WEFT_INLINE real splat(float value) {
    return splat(value, std::make_integer_sequence<int, kLanes>{});
}

WEFT_INLINE real square_root(real value) {
    real root;
    for (int lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(value[lane]);
    return root;
}

WEFT_INLINE item column(item i, int rows, int k) { return {i.first + rows * k, i.count}; }

template <int... Lane>
WEFT_INLINE integer lane_numbers(std::integer_sequence<int, Lane...>) {
    return integer{Lane...};
}

/// The lanes of fewer items than a pack has: those beyond the last repeat it.
WEFT_INLINE integer lanes_of(int count) {
    const integer lanes = lane_numbers(std::make_integer_sequence<int, kLanes>{});
    const integer last = integer{} + (count - 1);
    return lanes < last ? lanes : last;
}

#ifdef __AVX512F__

WEFT_INLINE __mmask16 mask_of(int count) { return static_cast<__mmask16>((1u << count) - 1u); }

template <class Vector, class T>
WEFT_INLINE Vector load_part(const T* p, int count) {
    return reinterpret_cast<Vector>(
        _mm512_maskz_permutexvar_epi32(mask_of(kLanes), reinterpret_cast<__m512i>(lanes_of(count)),
                                       _mm512_maskz_loadu_epi32(mask_of(count), p)));
}

template <class Vector, class T>
WEFT_INLINE void store_part(T* p, int count, const Vector& v) {
    _mm512_mask_storeu_epi32(p, mask_of(count), reinterpret_cast<__m512i>(v));
}

#else

template <class Vector, class T>
WEFT_INLINE Vector load_part(const T* p, int count) {
    Vector v;
    for (int lane = 0; lane < kLanes; ++lane) v[lane] = p[lane < count ? lane : count - 1];
    return v;
}

template <class Vector, class T>
WEFT_INLINE void store_part(T* p, int count, const Vector& v) {
    for (int lane = 0; lane < count; ++lane) p[lane] = v[lane];
}

#endif

template <class Vector, class T>
WEFT_INLINE Vector load_lanes(const T* p, item i) {
    if (i.count < kLanes) return load_part<Vector>(p + i.first, i.count);
    Vector v;
    std::memcpy(&v, p + i.first, sizeof v);
    return v;
}

template <class Vector, class T>
WEFT_INLINE void store_lanes(T* p, item i, const Vector& v) {
    if (i.count < kLanes) return store_part(p + i.first, i.count, v);
    std::memcpy(p + i.first, &v, sizeof v);
}

WEFT_INLINE real load(const float* p, item i) { return load_lanes<real>(p, i); }
WEFT_INLINE integer load_index(const int* p, item i) { return load_lanes<integer>(p, i); }
WEFT_INLINE void store(float* p, item i, real v) { store_lanes(p, i, v); }

WEFT_INLINE quad load_quad(const float4* p) {
    quad v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

// Both, one behind the other. (GCC makes two steps of a shuffle of what it has to load first.)
#ifdef __AVX__
WEFT_INLINE __m256 joined(quad lower, quad upper) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(lower), upper, 1);
}
#else
WEFT_INLINE real joined(quad lower, quad upper) {
    return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7);
}
#endif
#ifdef __AVX512DQ__
WEFT_INLINE __m512 joined(__m256 lower, __m256 upper) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(lower), upper, 1);
}
#endif

template <int A, int B, int C, int D, int... Lane>
WEFT_INLINE real in_quads(real a, real b, std::integer_sequence<int, Lane...>) {
    constexpr int from[4] = {A < 4 ? A : A - 4 + kLanes, B < 4 ? B : B - 4 + kLanes,
                             C < 4 ? C : C - 4 + kLanes, D < 4 ? D : D - 4 + kLanes};
    return __builtin_shufflevector(a, b, (from[Lane % 4] + Lane / 4 * 4)...);
}

/// In each 128 bits of the result, those values of the same 128 bits of a (0 to 3) and b (4 to 7).
template <int A, int B, int C, int D>
WEFT_INLINE real in_quads(real a, real b) {
    return in_quads<A, B, C, D>(a, b, std::make_integer_sequence<int, kLanes>{});
}

/// p[k[j]], p[k[j + 4]], ... of so many lanes.
template <int Count = kLanes / 4>
WEFT_INLINE auto every_fourth(const float4* p, integer k, int j) {
    if constexpr (Count == 1) {
        return load_quad(p + k[j]);
    } else {
        return joined(every_fourth<Count / 2>(p, k, j),
                      every_fourth<Count / 2>(p, k, j + 2 * Count));
    }
}

/// Reads a row of 4 per lane and turns them into 4 columns, 128 bits by 128 bits.
WEFT_INLINE real4 gather4(const float4* p, integer k) {
    const real rows[4] = {every_fourth(p, k, 0), every_fourth(p, k, 1), every_fourth(p, k, 2),
                          every_fourth(p, k, 3)};
    const real xy01 = in_quads<0, 4, 1, 5>(rows[0], rows[1]);
    const real xy23 = in_quads<0, 4, 1, 5>(rows[2], rows[3]);
    const real zw01 = in_quads<2, 6, 3, 7>(rows[0], rows[1]);
    const real zw23 = in_quads<2, 6, 3, 7>(rows[2], rows[3]);
    return {in_quads<0, 1, 4, 5>(xy01, xy23), in_quads<2, 3, 6, 7>(xy01, xy23),
            in_quads<0, 1, 4, 5>(zw01, zw23), in_quads<2, 3, 6, 7>(zw01, zw23)};
}

/// The way back.
WEFT_INLINE void scatter4(float4* p, integer k, real4 v) {
    const real xy01 = in_quads<0, 4, 1, 5>(v.x, v.y);
    const real xy23 = in_quads<2, 6, 3, 7>(v.x, v.y);
    const real zw01 = in_quads<0, 4, 1, 5>(v.z, v.w);
    const real zw23 = in_quads<2, 6, 3, 7>(v.z, v.w);
    const real rows[4] = {in_quads<0, 1, 4, 5>(xy01, zw01), in_quads<2, 3, 6, 7>(xy01, zw01),
                          in_quads<0, 1, 4, 5>(xy23, zw23), in_quads<2, 3, 6, 7>(xy23, zw23)};
    for (int lane = 0; lane < kLanes; ++lane) {
        std::memcpy(p + k[lane],
                    reinterpret_cast<const char*>(&rows[lane % 4]) + lane / 4 * sizeof(float4),
                    sizeof(float4));
    }
}

WEFT_INLINE integer lane_indices(item i) { return lanes_of(i.count) + i.first; }

WEFT_INLINE real4 load4(const float4* p, item i) { return gather4(p, lane_indices(i)); }
WEFT_INLINE void store4(float4* p, item i, real4 v) { scatter4(p, lane_indices(i), v); }

WEFT_KERNELS_END
