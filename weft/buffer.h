#pragma once

// Arrays that kernels work on.
//
//   weft::Buffer<float> heat("heat", 1000);        // zeroed; the name is for messages
//   for (float& h : heat.span()) h = 20.0f;
//
//   struct Cell { float heat, flux; };             // one's own elements: plain structs of float,
//   weft::Buffer<Cell> cells("cells", 1000);       // int and float4, written so that they are C, too
//
// Sizes are in elements. Between frames a buffer is the host's; it must outlive what runs on it.

#include "runtime/buffer.h"
