#pragma once

#include <memory>
#include <vector>

#include "runtime/device.h"
#include "runtime/trace/records.h"
#include "simulation/solver/solver.h"

namespace weft {

/// For traces: everything that is known before the first frame but the command line.
RunDescription describe_run(const Model& model, const Solver& solver,
                            const std::vector<std::unique_ptr<Device>>& devices);

}  // namespace weft
