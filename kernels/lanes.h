#ifndef WEFT_KERNELS_LANES_H
#define WEFT_KERNELS_LANES_H

// The part of the language that deals with the items of a pack one by one: what kernels need that
// fill or read tables of rows whose lengths they find out themselves. In a header of its own, so
// that all others stay as they are.
//
//   whole                    one int per item to reckon with: + - * and comparisons. (`integer` is
//                            for addresses; address(w) makes one of a whole)
//   mask                     what a comparison gives, for `m ? a : b`; no number
//   both(m, n)               a mask
//   splat_whole(n)           the same int for every item
//   item_numbers(i)          the number of every item
//   smaller_whole(a, b)      and larger_whole(a, b)
//   load_whole(p, i)         p[i]                      store_whole(p, i, v)
//   gather(p, k)             p[k], a float             gather_whole(p, k)   an int
//   store4_where(m, p, i, v)            a store for those items alone for which m holds
//   scatter_where(m, p, k, v)           likewise, of floats;
//   scatter_whole_where(m, p, k, v)     of ints; scatter4_where(m, p, k, v) of float4
//   any_item(m)              whether m holds for one of the items at hand
//   largest_whole(w)         over the items at hand: an int, and so a loop's bound that is the same
//                            for all of them
//   smallest_real(r), largest_real(r)   likewise: a float
//
// "The items at hand" are 16, 8 or fewer, or one, as the target has it; lanes beyond the last
// repeat it. So what any_item() and its like say differs from target to target. It may only decide
// how long work goes on that changes nothing where it need not be done:
//
//   for (int k = 0; k < largest_whole(length); ++k) {       bound uniform per pack
//       const mask on = splat_whole(k) < length;            ... what counts for this item
//       sum = sum + (on ? term : zero);
//   }
//   while (any_item(going)) { ... going = both(going, ...); }  each item as long as it has to

#include "kernels/platform.h"
#include "kernels/row_stride.h"

#if defined(__OPENCL_C_VERSION__)
#include "kernels/platform/opencl_lanes.h"
#elif !defined(WEFT_IN_DOUBLE)
#include "kernels/platform/host_lanes.h"
#endif

WEFT_KERNELS_BEGIN

#ifndef WEFT_IN_DOUBLE
WEFT_INLINE mask both(mask m, mask n) { return m & n; }
WEFT_INLINE whole smaller_whole(whole a, whole b) { return a < b ? a : b; }
WEFT_INLINE whole larger_whole(whole a, whole b) { return a > b ? a : b; }
#endif

WEFT_KERNELS_END

#endif
