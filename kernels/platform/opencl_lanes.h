// kernels/lanes.h in OpenCL C, with 1 or 8 lanes.

#if WEFT_LANES == 1

typedef int whole;
typedef int mask;

WEFT_INLINE integer address(whole w) { return w; }
WEFT_INLINE whole splat_whole(int n) { return n; }
WEFT_INLINE whole item_numbers(item i) { return i.first; }
WEFT_INLINE whole load_whole(__global const int* p, item i) { return p[i.first]; }
WEFT_INLINE void store_whole(__global int* p, item i, whole v) { p[i.first] = v; }
WEFT_INLINE real gather(__global const float* p, integer k) { return p[k]; }
WEFT_INLINE whole gather_whole(__global const int* p, integer k) { return p[k]; }

WEFT_INLINE void scatter4_where(mask m, __global float4* p, integer k, real4 v) {
    if (m) scatter4(p, k, v);
}
WEFT_INLINE void store4_where(mask m, __global float4* p, item i, real4 v) {
    scatter4_where(m, p, i.first, v);
}
WEFT_INLINE void scatter_where(mask m, __global float* p, integer k, real v) {
    if (m) p[k] = v;
}
WEFT_INLINE void scatter_whole_where(mask m, __global int* p, integer k, whole v) {
    if (m) p[k] = v;
}

WEFT_INLINE int any_item(mask m) { return m; }
WEFT_INLINE int largest_whole(whole w) { return w; }
WEFT_INLINE float smallest_real(real r) { return r; }
WEFT_INLINE float largest_real(real r) { return r; }

#else

typedef int8 whole;
typedef int8 mask;  // -1 or 0

WEFT_INLINE integer address(whole w) {
    integer k = {w.s0, w.s1, w.s2, w.s3, w.s4, w.s5, w.s6, w.s7};
    return k;
}
WEFT_INLINE whole number_of(integer k) {
    return (whole)(k.s0, k.s1, k.s2, k.s3, k.s4, k.s5, k.s6, k.s7);
}
WEFT_INLINE whole splat_whole(int n) { return (whole)(n); }
WEFT_INLINE whole item_numbers(item i) { return number_of(lane_indices(i)); }

WEFT_INLINE real gather(__global const float* p, integer k) {
    return (real)(p[k.s0], p[k.s1], p[k.s2], p[k.s3], p[k.s4], p[k.s5], p[k.s6], p[k.s7]);
}
WEFT_INLINE whole gather_whole(__global const int* p, integer k) {
    return (whole)(p[k.s0], p[k.s1], p[k.s2], p[k.s3], p[k.s4], p[k.s5], p[k.s6], p[k.s7]);
}
WEFT_INLINE whole load_whole(__global const int* p, item i) {
    if (i.count == 8) return vload8(0, p + i.first);
    return gather_whole(p, lane_indices(i));
}

// For every lane that m holds for.
#define WEFT_SCATTER_WHERE(m, p, k, v) \
    if (m.s0) p[k.s0] = v.s0;          \
    if (m.s1) p[k.s1] = v.s1;          \
    if (m.s2) p[k.s2] = v.s2;          \
    if (m.s3) p[k.s3] = v.s3;          \
    if (m.s4) p[k.s4] = v.s4;          \
    if (m.s5) p[k.s5] = v.s5;          \
    if (m.s6) p[k.s6] = v.s6;          \
    if (m.s7) p[k.s7] = v.s7;

WEFT_INLINE void scatter_where(mask m, __global float* p, integer k,
                               real v){WEFT_SCATTER_WHERE(m, p, k, v)} WEFT_INLINE
    void scatter_whole_where(mask m, __global int* p, integer k,
                             whole v){WEFT_SCATTER_WHERE(m, p, k, v)} WEFT_INLINE
    void store_whole(__global int* p, item i, whole v) {
    if (i.count == 8) {
        vstore8(v, 0, p + i.first);
        return;
    }
    scatter_whole_where(splat_whole(-1), p, lane_indices(i), v);
}

#define WEFT_STORE4_LANE(l) \
    if (m.l) p[k.l] = (float4)(v.x.l, v.y.l, v.z.l, v.w.l);

WEFT_INLINE void scatter4_where(mask m, __global float4* p, integer k, real4 v){
    WEFT_STORE4_LANE(s0) WEFT_STORE4_LANE(s1) WEFT_STORE4_LANE(s2) WEFT_STORE4_LANE(s3)
        WEFT_STORE4_LANE(s4) WEFT_STORE4_LANE(s5) WEFT_STORE4_LANE(s6)
            WEFT_STORE4_LANE(s7)} WEFT_INLINE
    void store4_where(mask m, __global float4* p, item i, real4 v) {
    scatter4_where(m, p, lane_indices(i), v);
}

WEFT_INLINE int any_item(mask m) { return any(m); }

WEFT_INLINE int largest_whole(whole w) {
    int4 four = max(w.lo, w.hi);
    return max(max(four.x, four.y), max(four.z, four.w));
}

// Not min() and max(): what these give where a lane is not a number is left to the driver.
WEFT_INLINE float smallest_real(real r) {
    float4 four = r.lo < r.hi ? r.lo : r.hi;
    float2 two = four.lo < four.hi ? four.lo : four.hi;
    return two.x < two.y ? two.x : two.y;
}
WEFT_INLINE float largest_real(real r) { return -smallest_real(-r); }

#endif
