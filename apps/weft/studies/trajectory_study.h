#pragma once

#include <vector>

#include "apps/weft/studies/error_study.h"
#include "simulation/output/trajectory_file.h"

namespace weft {

/// Runs all frames of the scene with each pair of substeps and iterations, by each solver, device
/// list and kind of plan, and measures how far they are from a run with far smaller steps. Throws
/// UserError, RunError.
TrajectoryStudy study_trajectories(const ErrorOptions& options);

/// Marks the points that no other one beats in time without being further away.
void mark_front(std::vector<TrajectoryCurve>& curves);

}  // namespace weft
