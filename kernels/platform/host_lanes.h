#pragma once

// kernels/lanes.h in scalar and packed C++.

WEFT_KERNELS_BEGIN

using whole = integer;

#ifdef WEFT_PACKED_TARGET

using mask = integer;  ///< -1 or 0, as comparisons of packs give it

/// Bit by bit the lanes for which m holds.
WEFT_INLINE unsigned lane_bits(mask m) {
#if defined(__AVX512DQ__)
    return _mm512_movepi32_mask(reinterpret_cast<__m512i>(m));
#elif defined(__AVX__)
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(m)));
#else
    unsigned bits = 0;
    for (int lane = 0; lane < kLanes; ++lane) bits |= m[lane] != 0 ? 1u << lane : 0u;
    return bits;
#endif
}

WEFT_INLINE bool any_item(mask m) { return lane_bits(m) != 0; }

template <class Vector, class Best, int... Lane>
WEFT_INLINE auto best_of_lanes(Vector v, Best best, std::integer_sequence<int, Lane...>) {
    if constexpr (kLanes > 8) v = best(v, __builtin_shufflevector(v, v, (Lane ^ 8)...));
    v = best(v, __builtin_shufflevector(v, v, (Lane ^ 4)...));
    v = best(v, __builtin_shufflevector(v, v, (Lane ^ 2)...));
    v = best(v, __builtin_shufflevector(v, v, (Lane ^ 1)...));
    return v[0];
}

/// What `best(a, b)` leaves of all lanes.
template <class Vector, class Best>
WEFT_INLINE auto best_of_lanes(Vector v, Best best) {
    return best_of_lanes(v, best, std::make_integer_sequence<int, kLanes>{});
}

WEFT_INLINE int largest_whole(whole w) {
    return best_of_lanes(w, [](whole a, whole b) { return a > b ? a : b; });
}

WEFT_INLINE float smallest_real(real r) {
    return best_of_lanes(r, [](real a, real b) { return a < b ? a : b; });
}

/// Calls action(lane) for the lanes for which m holds, in order.
template <class Action>
WEFT_INLINE void for_lanes(mask m, Action action) {
    for (unsigned bits = lane_bits(m); bits != 0; bits &= bits - 1) action(std::countr_zero(bits));
}

template <class T, class Pack>
WEFT_INLINE void scatter_lanes(mask m, T* p, integer k, const Pack& v) {
    for_lanes(m, [&](int lane) { p[k[lane]] = v[lane]; });
}

WEFT_INLINE void scatter_where(mask m, float* p, integer k, real v) { scatter_lanes(m, p, k, v); }
WEFT_INLINE void scatter_whole_where(mask m, int* p, integer k, whole v) {
    scatter_lanes(m, p, k, v);
}

WEFT_INLINE void scatter4_where(mask m, float4* p, integer k, real4 v) {
    if (!any_item(m)) return;
    float4 rows[kLanes];
    store4(rows, {0, kLanes}, v);
    for_lanes(m, [&](int lane) { p[k[lane]] = rows[lane]; });
}

WEFT_INLINE whole splat_whole(int n) { return whole{} + n; }
WEFT_INLINE whole item_numbers(item i) { return lane_indices(i); }

WEFT_INLINE real gather(const float* p, integer k) {
    real v{};
    for (int lane = 0; lane < kLanes; ++lane) v[lane] = p[k[lane]];
    return v;
}

WEFT_INLINE whole gather_whole(const int* p, integer k) {
    whole v{};
    for (int lane = 0; lane < kLanes; ++lane) v[lane] = p[k[lane]];
    return v;
}

WEFT_INLINE void store_whole(int* p, item i, whole v) { store_lanes(p, i, v); }

#else

using mask = bool;

WEFT_INLINE bool any_item(mask m) { return m; }
WEFT_INLINE whole splat_whole(int n) { return n; }
WEFT_INLINE whole item_numbers(item i) { return i.first; }
WEFT_INLINE real gather(const float* p, integer k) { return p[k]; }
WEFT_INLINE whole gather_whole(const int* p, integer k) { return p[k]; }
WEFT_INLINE void store_whole(int* p, item i, whole v) { p[i.first] = v; }
WEFT_INLINE int largest_whole(whole w) { return w; }
WEFT_INLINE float smallest_real(real r) { return r; }

WEFT_INLINE void scatter_where(mask m, float* p, integer k, real v) {
    if (m) p[k] = v;
}
WEFT_INLINE void scatter_whole_where(mask m, int* p, integer k, whole v) {
    if (m) p[k] = v;
}
WEFT_INLINE void scatter4_where(mask m, float4* p, integer k, real4 v) {
    if (m) scatter4(p, k, v);
}

#endif

WEFT_INLINE integer address(whole w) { return w; }
WEFT_INLINE whole load_whole(const int* p, item i) { return load_index(p, i); }

WEFT_INLINE void store4_where(mask m, float4* p, item i, real4 v) {
    scatter4_where(m, p, address(item_numbers(i)), v);
}

WEFT_INLINE float largest_real(real r) { return -smallest_real(-r); }

WEFT_KERNELS_END
