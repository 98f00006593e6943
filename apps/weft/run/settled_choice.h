#pragma once

#include <filesystem>

#include "apps/weft/run/run_options.h"
#include "simulation/choice/solver_choice.h"

namespace weft {

/// The solver for a scene that leaves it to Weft: a run that goes on (--resume) has the one that it
/// began with, as `checkpoint` says, if that file is there; any other has it measured. Throws
/// UserError, RunError.
SolverChoice settled_choice(const Scene& scene, const RunOptions& options,
                            const std::filesystem::path& checkpoint);

}  // namespace weft
