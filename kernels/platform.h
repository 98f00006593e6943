#ifndef WEFT_KERNELS_PLATFORM_H
#define WEFT_KERNELS_PLATFORM_H

// The language layer: with lanes.h, its second part, and with in_order.h and members.h, which build
// on it, the only files that ask which compiler is reading them.
//
// A kernel is written once, on the words below, and becomes
//   OpenCL C 1.2, one item or 8 items per work-item     platform/opencl.h
//   scalar C++, one item at a time                      platform/scalar.h
//   packed C++, 8 or 16 items at a time                 platform/packed.h
// and gives the same bits in all of them: only + - * / square_root() and comparisons, never
// contracted, always correctly rounded. Helpers without loads and stores (element energies) compile
// with real = double, too, for the reference solver: platform/in_double.h.
//
// WEFT_KERNEL(name, parameters...) { ... } between WEFT_KERNELS_BEGIN and WEFT_KERNELS_END is a
// kernel; motion.h has short ones. With WEFT_NARROW_KERNEL packs have 8 items at the most: where
// items wait for the slowest of their pack, or for all of them (any_item() and others of lanes.h),
// wider packs lose more than they gain. The words:
//
//   i                  the item, in a kernel's body
//   real, integer      one value per item: a float, an int, or 8 or 16 of them
//   real3, real4       structs of real; vector.h has their arithmetic
//   item               the items of this call: kLanes of them, or fewer at the end of a range
//   splat(f)           the same value for every item
//   condition ? a : b  chooses per item; both sides are computed, so neither may trap
//   load(p, i)         p[i], a float of each item          store(p, i, v)
//   load_index(p, i)   p[i], an int of each item
//   load4(p, i)        a float4 of each item               store4(p, i, v)
//   gather4(p, k)      p[k], k an integer of each item     scatter4(p, k, v)
//   column(i, n, k)    the items, k columns further in a column-major table with n rows
//
// The last call of a range may have fewer items. Lanes beyond them repeat the last item:
// they compute the same bits and store them to the same place again.
//
// Buffers hold float, int or float4 (float3 takes 16 bytes in OpenCL, so it never lies in memory).
// Parameters are pointers (WEFT_GLOBAL), float or int. Helpers take and return values and are
// WEFT_INLINE. What is C++ but no C (real3 x{...}, references, overloads) compiles, and is refused
// when a run builds its kernels, or before by `./dev lint`.

#if defined(__OPENCL_C_VERSION__)  // by the compiler; __OPENCL_VERSION__ only by a device
#include "kernels/platform/opencl.h"
#elif defined(WEFT_IN_DOUBLE)
#include "kernels/platform/in_double.h"
#elif defined(WEFT_PACKED_TARGET)
#include "kernels/platform/packed.h"
#else
#include "kernels/platform/scalar.h"
#endif

#endif
