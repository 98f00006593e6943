#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "simulation/reference/newton.h"

namespace weft {

/// A solver's state after so many iterations of the step.
struct ErrorPoint {
    int iteration = 0;
    double time = 0.0;  ///< [s] from the step's beginning
    double energy = 0.0;
    double relative_error = 0.0;  ///< (E - E*) / (E0 - E*)
    /// Of it, as runs make it (step_error.h); NaN: none.
    double estimate = std::numeric_limits<double>::quiet_NaN();
    /// Vertices that contact's planes, which are no part of E, may hold back: they have gone
    /// farther than the nearest one is away.
    int truncated = 0;
};

/// One solver on one device list by one kind of plan. Its points begin with iteration 0, the start.
struct ErrorCurve {
    std::string solver, devices, plan;
    std::vector<ErrorPoint> points;
    std::string end;  ///< why it ends where it does
};

struct ErrorStudy {
    std::string scene;
    int frame = 0;
    int vertices = 0;
    double step = 0.0;                  ///< [s]
    std::vector<std::string> energies;  ///< what E is the sum of
    std::vector<std::string> notes;     ///< among them: what is no part of E
    Minimum minimum;
    /// Relative error of the minimiser itself with its positions rounded to float32: what no solver
    /// in single precision can be expected to get far below.
    double rounding_floor = 0.0;
    std::vector<ErrorCurve> curves;
};

/// error.h5: what is known of the problem as attributes and in the group `reference`, and a group
/// per curve with its points. Throws RunError.
void write_error_file(const std::filesystem::path& path, const ErrorStudy& study);

}  // namespace weft
