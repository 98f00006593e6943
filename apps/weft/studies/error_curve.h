#pragma once

#include <string>
#include <vector>

#include "apps/weft/studies/error_problem.h"

namespace weft {

/// What was measured of one curve: its points, how it ended, and the state of least E.
struct MeasuredCurve {
    std::vector<ErrorPoint> points;
    std::string end;
    std::vector<float> positions;  ///< xyz in scene order

    void add(const ErrorPoint& point, std::vector<float> at);
    double least_energy() const;  ///< infinite without points
};

/// Where newton (with contact: vbd) gets in one step, to start the reference from: in seconds
/// within 1e-4 or so of what takes double precision minutes to come near from far away. Empty where
/// newton fails.
std::vector<Vec3> good_guess(const ErrorOptions& options, const ErrorProblem& problem);

/// Where the first solver gets alone, with far more iterations than curves have. Throws RunError.
std::vector<Vec3> far_end(const ErrorOptions& options, const ErrorProblem& problem, int iterations);

/// Runs the step with more and more iterations, in a process of its own. run: solver, devices, plan
MeasuredCurve measure_curve(const ErrorOptions& options, const RunOptions& run,
                            const ErrorProblem& problem);

}  // namespace weft
