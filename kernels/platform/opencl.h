// OpenCL C 1.2. WEFT_LANES is 1 or 8, given when the program is built: 1 for GPUs, whose hardware
// packs work-items, and 8 for CPU devices, whose vector units we fill ourselves. WEFT_KERNEL() is
// no macro here, as OpenCL C has none with "...": it is written out where a program's text is made.

#ifndef WEFT_FAST_MATH
#pragma OPENCL FP_CONTRACT OFF
#endif

#ifndef WEFT_LANES
#define WEFT_LANES 1
#endif

#define WEFT_GLOBAL __global
#if WEFT_LANES == 1
#define WEFT_INLINE static inline
#else
// Packs of 8 have to stay in registers, and the test for a full pack has to fold away.
#define WEFT_INLINE static inline __attribute__((always_inline))
#endif
#define WEFT_KERNELS_BEGIN
#define WEFT_KERNELS_END

typedef struct {
    int first;
    int count;
} item;

#if WEFT_LANES == 1
typedef float real;
typedef int integer;
#else
typedef float8 real;
// Not int8: indices become addresses, and eight loads are faster than taking a register apart.
typedef struct {
    int s0, s1, s2, s3, s4, s5, s6, s7;
} integer;
#endif

typedef struct {
    real x, y, z, w;
} real4;

WEFT_INLINE real splat(float value) { return (real)(value); }
WEFT_INLINE real square_root(real value) { return sqrt(value); }

WEFT_INLINE item column(item i, int rows, int k) {
    i.first += rows * k;
    return i;
}

#if WEFT_LANES == 1

WEFT_INLINE real4 gather4(__global const float4* p, integer k) {
    float4 row = p[k];
    real4 v = {row.x, row.y, row.z, row.w};
    return v;
}
WEFT_INLINE void scatter4(__global float4* p, integer k, real4 v) {
    p[k] = (float4)(v.x, v.y, v.z, v.w);
}
WEFT_INLINE integer lane_indices(item i) { return i.first; }

WEFT_INLINE real load(__global const float* p, item i) { return p[i.first]; }
WEFT_INLINE integer load_index(__global const int* p, item i) { return p[i.first]; }
WEFT_INLINE void store(__global float* p, item i, real v) { p[i.first] = v; }

#else

/// Lane j of an item with at least one and at most 8 lanes; lanes beyond the last repeat it.
#define WEFT_LANE(i, j) ((i).first + min(j, (i).count - 1))

WEFT_INLINE integer lane_indices(item i) {
    integer k = {i.first,         WEFT_LANE(i, 1), WEFT_LANE(i, 2), WEFT_LANE(i, 3),
                 WEFT_LANE(i, 4), WEFT_LANE(i, 5), WEFT_LANE(i, 6), WEFT_LANE(i, 7)};
    return k;
}

// Rows of 4 to columns of 8 and back, in pairs of 128-bit halves as in packed.h: written like this,
// a compiler sees shuffles of whole registers.
#define WEFT_LOW_PAIRS(a, b) (real)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5)
#define WEFT_HIGH_PAIRS(a, b) (real)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7)
#define WEFT_LOW_QUADS(a, b) (real)(a.s01, b.s01, a.s45, b.s45)
#define WEFT_HIGH_QUADS(a, b) (real)(a.s23, b.s23, a.s67, b.s67)

WEFT_INLINE real4 gather4(__global const float4* p, integer k) {
    real row0 = (real)(p[k.s0], p[k.s4]);
    real row1 = (real)(p[k.s1], p[k.s5]);
    real row2 = (real)(p[k.s2], p[k.s6]);
    real row3 = (real)(p[k.s3], p[k.s7]);
    real xy01 = WEFT_LOW_PAIRS(row0, row1);
    real xy23 = WEFT_LOW_PAIRS(row2, row3);
    real zw01 = WEFT_HIGH_PAIRS(row0, row1);
    real zw23 = WEFT_HIGH_PAIRS(row2, row3);
    real4 v;
    v.x = WEFT_LOW_QUADS(xy01, xy23);
    v.y = WEFT_HIGH_QUADS(xy01, xy23);
    v.z = WEFT_LOW_QUADS(zw01, zw23);
    v.w = WEFT_HIGH_QUADS(zw01, zw23);
    return v;
}

WEFT_INLINE void scatter4(__global float4* p, integer k, real4 v) {
    real xy01 = WEFT_LOW_PAIRS(v.x, v.y);
    real xy23 = WEFT_HIGH_PAIRS(v.x, v.y);
    real zw01 = WEFT_LOW_PAIRS(v.z, v.w);
    real zw23 = WEFT_HIGH_PAIRS(v.z, v.w);
    real row0 = WEFT_LOW_QUADS(xy01, zw01);
    real row1 = WEFT_HIGH_QUADS(xy01, zw01);
    real row2 = WEFT_LOW_QUADS(xy23, zw23);
    real row3 = WEFT_HIGH_QUADS(xy23, zw23);
    p[k.s0] = row0.lo;
    p[k.s1] = row1.lo;
    p[k.s2] = row2.lo;
    p[k.s3] = row3.lo;
    p[k.s4] = row0.hi;
    p[k.s5] = row1.hi;
    p[k.s6] = row2.hi;
    p[k.s7] = row3.hi;
}

WEFT_INLINE real load(__global const float* p, item i) {
    if (i.count == 8) return vload8(0, p + i.first);
    integer k = lane_indices(i);
    return (real)(p[k.s0], p[k.s1], p[k.s2], p[k.s3], p[k.s4], p[k.s5], p[k.s6], p[k.s7]);
}

WEFT_INLINE integer load_index(__global const int* p, item i) {
    integer k = lane_indices(i);
    integer v = {p[k.s0], p[k.s1], p[k.s2], p[k.s3], p[k.s4], p[k.s5], p[k.s6], p[k.s7]};
    return v;
}

WEFT_INLINE void store(__global float* p, item i, real v) {
    if (i.count == 8) {
        vstore8(v, 0, p + i.first);
        return;
    }
    integer k = lane_indices(i);
    p[k.s0] = v.s0;
    p[k.s1] = v.s1;
    p[k.s2] = v.s2;
    p[k.s3] = v.s3;
    p[k.s4] = v.s4;
    p[k.s5] = v.s5;
    p[k.s6] = v.s6;
    p[k.s7] = v.s7;
}

#endif

WEFT_INLINE real4 load4(__global const float4* p, item i) { return gather4(p, lane_indices(i)); }
WEFT_INLINE void store4(__global float4* p, item i, real4 v) { scatter4(p, lane_indices(i), v); }
