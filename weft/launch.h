#pragma once

// Kernels with their arguments, and where the items of each strip lie.
//
// A strip is a range of items that one worker does in a row; strips are done at the same time, on
// any device. 1000 items in 10 strips:
//
//   weft::Buffer<int> begin("rows", 11);                       // where each strip begins, and the end
//   for (int s = 0; s <= 10; ++s) begin[s] = 100 * s;
//   const weft::Segments rows{&begin, 0, 1, 10};
//   weft::launch(heat::diffuse, rows, now, next, 0.25f, 1000);  // one argument per parameter
//
// weft::even_strips(begin) does the same. A missing argument, or one of another type than the
// kernel's parameter, does not compile. weft::kInstance stands for an int that is the number of the
// step within its frame.

#include "runtime/launch.h"
