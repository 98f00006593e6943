#ifndef WEFT_KERNEL_H
#define WEFT_KERNEL_H

// The language of kernels. A header of one's own, given to weft_add_kernels() in CMake:
//
//   #ifndef HEAT_H
//   #define HEAT_H
//   #include <weft/kernel.h>
//
//   WEFT_KERNELS_IN(heat)
//
//   /// next = now + rate (left - 2 now + right); now, next [rows]
//   WEFT_KERNEL(diffuse, WEFT_GLOBAL const float* now, WEFT_GLOBAL float* next, float rate,
//               int rows) { ... }
//
//   WEFT_KERNELS_END
//   #endif
//
// heat::diffuse is then what weft::launch() takes (weft/launch.h). The header is C and C++ at once:
// use #ifndef, not #pragma once, and no more of C++ than the words below.

#if defined(__OPENCL_C_VERSION__)
#define WEFT_KERNELS_IN(space)
#else
#include "kernels/platform/types.h"
#include "kernels/sources.h"
#endif

#include "kernels/columns.h"
#include "kernels/lanes.h"
#include "kernels/members.h"
#include "kernels/platform.h"
#include "kernels/vector.h"

#endif
