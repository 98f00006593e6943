#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/weft/run/run_options.h"
#include "simulation/output/error_file.h"

namespace weft {

/// What `weft error` is asked to do.
struct ErrorOptions {
    RunOptions run;
    std::optional<int> frame;
    std::optional<std::string> start;  ///< file with the state that the step begins at
    std::vector<std::string> solvers, devices, plans;
    /// [s] that the measurements of one curve may take; null: what fits the mode
    std::optional<double> time;
    int max_iterations = 1000;
    /// They stay in the step, and errors are distances from where the first solver ends.
    bool obstacles = false;
    bool planes = false;    ///< of contacts: they stay in the step, and hold back
    bool as_sweep = false;  ///< nothing is measured: a sweep is made that does

    // For whole runs.
    bool trajectory = false;
    std::vector<int> sweep_substeps{1, 2, 4, 8, 16, 32, 64};
    std::vector<int> sweep_iterations{1, 2, 4, 8, 16, 32, 64};
    int max_work = 128;                     ///< substeps * iterations of a run
    std::optional<int> reference_substeps;  ///< null: see TrajectoryReference
};

/// Measures all curves. Throws UserError, RunError.
ErrorStudy study_errors(const ErrorOptions& options);

/// The numbers of iterations that are measured: all up to 16, then in steps of about a fifth.
std::vector<int> measured_iterations(int most);

/// The first point of the curve that is at or below `error`; null if none is.
const ErrorPoint* first_below(const ErrorCurve& curve, double error);

}  // namespace weft
