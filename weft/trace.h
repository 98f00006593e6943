#pragma once

// What traces hold, and reading them. A Runner writes one (RunnerOptions::trace).
//
//   const weft::TraceReader trace("heat.h5");
//   for (std::size_t f = 0; f < trace.frames().size(); ++f) {
//       runner.replay(trace.run(), trace.frame(f));       // every task where it was, in its order
//   }
//   runner.state_hash() == trace.state_hash();
//
// Times are seconds since the run's start. UserError tells what is wrong with a file.

#include "runtime/trace/records.h"
#include "runtime/trace/trace_reader.h"
#include "runtime/trace/trace_writer.h"
