#pragma once

// Runs work on all devices, planned anew in every frame.
//
//   weft::Runner runner(work, {.devices = "hybrid", .trace = "heat.h5"});
//   for (int frame = 0; frame < 100; ++frame) {
//       const weft::FrameRecord record = runner.advance(20);         // 20 steps
//       std::printf("%g ms, planned %g\n", 1e3 * record.measured_makespan,
//                   1e3 * record.planned_makespan);
//   }
//   now[17];                                                         // the state is the host's here
//   runner.finish();
//
// `weft trace gantt heat.h5` draws what happened.

#include "runtime/error.h"
#include "runtime/planning/plan_kind.h"
#include "runtime/planning/runner.h"
