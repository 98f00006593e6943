#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/device.h"
#include "runtime/trace/records.h"
#include "simulation/solver/solver.h"

namespace weft {

/// For traces: everything that is known before the first frame but the command line.
RunDescription describe_run(const Model& model, const Solver& solver,
                            const std::vector<std::unique_ptr<Device>>& devices);

/// The setting "origin": what a model's positions count from, "9984 0 0"; empty: 0, and not told.
std::string origin_setting(const Model& model);

}  // namespace weft
