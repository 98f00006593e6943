#pragma once

#include <string>

#include "simulation/checks/step_error.h"

namespace weft {

/// Which iterations, substeps or other solver would bring a step below scene.solver.tolerance:
/// found by doing that step again with more of each, within limits. In words that go on a sentence.
/// scene: with its substeps. ends: of the step; only its start is looked at
std::string advise_tolerance(const Scene& scene, const SubstepEnds& ends);

}  // namespace weft
