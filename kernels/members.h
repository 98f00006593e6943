#ifndef WEFT_KERNELS_MEMBERS_H
#define WEFT_KERNELS_MEMBERS_H

// Elements of one's own types. A buffer may hold any struct of floats and ints, which is written so
// that it is C as well; kernels take a pointer to it and work on its members:
//
//   typedef struct { float heat, flux; int zone; } Cell;
//   WEFT_KERNEL(cool, WEFT_GLOBAL Cell* cells, float factor) {
//       store_member(cells, i, heat, load_member(cells, i, heat) * splat(factor));
//   }
//
//   load_member(p, i, m)         p[i].m, a float of each item   store_member(p, i, m, v)
//   gather_member(p, k, m)       p[k].m, k an integer           scatter_member(p, k, m, v)
//   load_index_member(p, i, m)   p[i].m, an int of each item
//   gather_index_member(p, k, m) p[k].m, likewise

#include "kernels/platform.h"

#if defined(__OPENCL_C_VERSION__) && WEFT_LANES != 1

#define WEFT_MEMBERS(p, k, m)                                                                 \
    (p)[(k).s0].m, (p)[(k).s1].m, (p)[(k).s2].m, (p)[(k).s3].m, (p)[(k).s4].m, (p)[(k).s5].m, \
        (p)[(k).s6].m, (p)[(k).s7].m
#define gather_member(p, k, m) ((real)(WEFT_MEMBERS(p, k, m)))
#define gather_index_member(p, k, m) ((integer){WEFT_MEMBERS(p, k, m)})
#define load_member(p, i, m) gather_member(p, lane_indices(i), m)
#define load_index_member(p, i, m) gather_index_member(p, lane_indices(i), m)
#define scatter_member(p, k, m, v)         \
    do {                                   \
        integer weft_at = (k);             \
        real weft_value = (v);             \
        (p)[weft_at.s0].m = weft_value.s0; \
        (p)[weft_at.s1].m = weft_value.s1; \
        (p)[weft_at.s2].m = weft_value.s2; \
        (p)[weft_at.s3].m = weft_value.s3; \
        (p)[weft_at.s4].m = weft_value.s4; \
        (p)[weft_at.s5].m = weft_value.s5; \
        (p)[weft_at.s6].m = weft_value.s6; \
        (p)[weft_at.s7].m = weft_value.s7; \
    } while (0)
#define store_member(p, i, m, v) scatter_member(p, lane_indices(i), m, v)

#elif !defined(WEFT_PACKED_TARGET)

#define load_member(p, i, m) ((p)[(i).first].m)
#define gather_member(p, k, m) ((p)[k].m)
#define load_index_member(p, i, m) ((p)[(i).first].m)
#define gather_index_member(p, k, m) ((p)[k].m)
#define store_member(p, i, m, v) ((p)[(i).first].m = (v))
#define scatter_member(p, k, m, v) ((p)[k].m = (v))

#else

WEFT_KERNELS_BEGIN

/// A pack of what `get` gives for each lane's address.
template <class Pack, class Get>
WEFT_INLINE Pack gather_by(integer k, Get get) {
    Pack v{};
    for (int lane = 0; lane < kLanes; ++lane) v[lane] = get(k[lane]);
    return v;
}

WEFT_KERNELS_END

#define gather_member(p, k, member) \
    gather_by<real>(k, [&](int weft_at) { return (p)[weft_at].member; })
#define gather_index_member(p, k, member) \
    gather_by<integer>(k, [&](int weft_at) { return (p)[weft_at].member; })
#define load_member(p, i, member) gather_member(p, lane_indices(i), member)
#define load_index_member(p, i, member) gather_index_member(p, lane_indices(i), member)
#define scatter_member(p, k, member, v)                             \
    do {                                                            \
        const integer weft_at = (k);                                \
        const real weft_value = (v);                                \
        for (int weft_lane = 0; weft_lane < kLanes; ++weft_lane) {  \
            (p)[weft_at[weft_lane]].member = weft_value[weft_lane]; \
        }                                                           \
    } while (false)
#define store_member(p, i, member, v) scatter_member(p, lane_indices(i), member, v)

#endif

#endif
