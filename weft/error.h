#pragma once

// What Weft throws.
//
//   try {
//       weft::Runner runner(work, {.devices = argv[1]});
//       runner.advance(8);
//   } catch (const weft::UserError& error) {   // the request was wrong: a device list, a file
//       std::fprintf(stderr, "%s\n", error.what());
//       return 2;
//   } catch (const weft::RunError& error) {    // the run failed: the last device is lost, disk full
//       std::fprintf(stderr, "%s\n", error.what());
//       return 1;
//   }
//
// weft::Misuse is left out on purpose: it tells of a mistake in the program itself. The scheduler,
// which stands alone, throws weft::scheduler::GraphError (weft/schedule.h).

#include "runtime/error.h"
