#pragma once

#include <string>
#include <vector>

#include "apps/weft/run/run_options.h"

namespace weft {

/// Everything that is known of a run before its first frame: what was asked for, of whom, and on
/// what it runs.
RunDescription describe_run(const Simulation& simulation, const RunOptions& options);

/// The devices that cannot keep strict arithmetic's promise.
std::vector<std::string> loose_devices(const Simulation& simulation);

}  // namespace weft
