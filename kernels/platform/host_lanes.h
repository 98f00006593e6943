#pragma once

// kernels/lanes.h in scalar and packed C++.

WEFT_KERNELS_BEGIN

using whole = integer;

#ifdef WEFT_PACKED_TARGET

using mask = integer;  ///< -1 or 0, as comparisons of packs give it

template <class Pack>
WEFT_INLINE auto lane_of(const Pack& pack, int lane) {
    return pack[lane];
}

WEFT_INLINE bool any_item(mask m) {
    typedef long long halves __attribute__((vector_size(32)));
    const halves h = reinterpret_cast<halves>(m);
    return (h[0] | h[1] | h[2] | h[3]) != 0;
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

WEFT_INLINE void store_whole(int* p, item i, whole v) {
    if (i.count == kLanes) {
        std::memcpy(p + i.first, &v, sizeof v);
    } else {
        for (int lane = 0; lane < i.count; ++lane) p[i.first + lane] = v[lane];
    }
}

#else

using mask = bool;

template <class Value>
WEFT_INLINE Value lane_of(Value value, int) {
    return value;
}

WEFT_INLINE bool any_item(mask m) { return m; }
WEFT_INLINE whole splat_whole(int n) { return n; }
WEFT_INLINE whole item_numbers(item i) { return i.first; }
WEFT_INLINE real gather(const float* p, integer k) { return p[k]; }
WEFT_INLINE whole gather_whole(const int* p, integer k) { return p[k]; }
WEFT_INLINE void store_whole(int* p, item i, whole v) { p[i.first] = v; }

#endif

WEFT_INLINE integer address(whole w) { return w; }
WEFT_INLINE whole load_whole(const int* p, item i) { return load_index(p, i); }

template <class T, class Pack>
WEFT_INLINE void scatter_lanes(mask m, T* p, integer k, const Pack& v) {
    for (int lane = 0; lane < kLanes; ++lane) {
        if (lane_of(m, lane)) p[lane_of(k, lane)] = lane_of(v, lane);
    }
}

WEFT_INLINE void scatter_where(mask m, float* p, integer k, real v) { scatter_lanes(m, p, k, v); }
WEFT_INLINE void scatter_whole_where(mask m, int* p, integer k, whole v) {
    scatter_lanes(m, p, k, v);
}

WEFT_INLINE void scatter4_where(mask m, float4* p, integer k, real4 v) {
    for (int lane = 0; lane < kLanes; ++lane) {
        if (!lane_of(m, lane)) continue;
        p[lane_of(k, lane)] = {lane_of(v.x, lane), lane_of(v.y, lane), lane_of(v.z, lane),
                               lane_of(v.w, lane)};
    }
}

WEFT_INLINE void store4_where(mask m, float4* p, item i, real4 v) {
    scatter4_where(m, p, address(item_numbers(i)), v);
}

WEFT_INLINE int largest_whole(whole w) {
    int most = lane_of(w, 0);
    for (int lane = 1; lane < kLanes; ++lane) {
        if (lane_of(w, lane) > most) most = lane_of(w, lane);
    }
    return most;
}

WEFT_INLINE float smallest_real(real r) {
    float least = lane_of(r, 0);
    for (int lane = 1; lane < kLanes; ++lane) {
        if (lane_of(r, lane) < least) least = lane_of(r, lane);
    }
    return least;
}

WEFT_INLINE float largest_real(real r) { return -smallest_real(-r); }

WEFT_KERNELS_END
