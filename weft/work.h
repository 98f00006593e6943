#pragma once

// Work that can be planned for any devices.
//
//   weft::StripWork work(10);                                        // strips
//   work.add("there", weft::launch(heat::diffuse, rows, now, next, rate, count))
//       .reads(now, rows, 1)                                         // and a strip on either side
//       .updates(next, rows);
//   work.add("back", weft::launch(heat::diffuse, rows, next, now, rate, count))
//       .reads(next, rows, 1)
//       .updates(now, rows);
//
// StepWork takes any one Step instead, and places its tasks one by one. Work of any other form
// derives from weft::Work: a step for each partition of the strips. Misuse says what does not fit.

#include "runtime/planning/partition.h"
#include "runtime/planning/step_maker.h"
#include "runtime/planning/work.h"
#include "runtime/row_table.h"
