#pragma once

#include "simulation/checks/step_error.h"

namespace weft {

/// One step of a scene, done again and again from the same start, on one core: by other solvers,
/// with more iterations, as several shorter ones.
class StepTrials {
public:
    struct Result {
        double error;    ///< relative, as StepError estimates it; infinite where it has no meaning
        double seconds;  ///< that the step took
    };

    /// scene: with its substeps. start: only the substep's start is looked at. parts: that it is
    /// divided into; only the first is done
    StepTrials(const Scene& scene, SubstepEnds start, int parts = 1);

    /// Of so many repetitions, after one that does not count where there are several, the fastest.
    /// Both are infinite where the solver fails.
    Result run(Method method, int iterations, int repetitions = 1);
    /// How many iterations a method may be tried with.
    int most_iterations_of(Method method) const;

private:
    Scene scene_;
    SubstepEnds start_;
    int frame_;
    StepError error_;
};

}  // namespace weft
