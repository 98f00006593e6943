#ifndef WEFT_KERNELS_IN_ORDER_H
#define WEFT_KERNELS_IN_ORDER_H

/// In front of a loop that adds up plain numbers, outside of the lanes: they are added one after
/// the other. (OpenCL asks for that in any case; but Intel's compiler, of 2026, takes such a sum
/// apart from 16 numbers on.)
#if defined(__OPENCL_C_VERSION__)
#define WEFT_IN_ORDER _Pragma("clang loop vectorize(disable) interleave(disable)")
#else
#define WEFT_IN_ORDER
#endif

#endif
