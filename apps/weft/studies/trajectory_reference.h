#pragma once

#include <string>

#include "apps/weft/studies/error_study.h"
#include "apps/weft/studies/whole_run.h"

namespace weft {

/// The run that whole runs are compared with, by far smaller steps than theirs.
struct TrajectoryReference {
    std::string by;  ///< what made it, in words
    int vertices = 0;
    int substeps = 0;
    Trajectory trajectory;
    /// [m] RMS distance from itself with half as many substeps: how far it is sure.
    double doubt = 0.0;
};

/// Explicit and in double precision (FineRun), which leans on none of the solvers; but that knows
/// no contact, and keeps no triangles out of narrow obstacles, so with either it is a solver's.
/// With substeps left out, there are 8 times the most that are swept, of a solver's twice. Throws
/// UserError, RunError.
TrajectoryReference run_reference(const ErrorOptions& options);

}  // namespace weft
