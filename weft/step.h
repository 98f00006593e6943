#pragma once

// Task graphs of launches. What depends on what follows from what tasks read and write.
//
//   const weft::TaskBody diffuse{"diffuse", 0, {weft::launch(heat::diffuse, rows, now, next, ...)}};
//   weft::Step step;
//   step.add(diffuse, 0, {0, 5}).reads(now, 0, 501).updates(next, 0, 500);  // strips 0 to 5
//   step.add(diffuse, 0, {5, 10}).reads(now, 499, 1000).updates(next, 500, 1000);
//   step.seal();
//
// weft/work.h makes such steps of work over strips, for any number of devices; weft/runner.h runs
// them. Misuse says which task and which buffer.

#include "runtime/step.h"
