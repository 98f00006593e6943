#pragma once

#include <vector>

#include "simulation/checks/step_error.h"

namespace weft {

class Model;

/// [bodies] 1: all that bears or pushes the body at the substep's end is in the step's energy:
/// pins, by its own elements and those of what it is tied to, or contacts. 0: nothing bears it, or
/// obstacles touch it, whose pushes are not.
std::vector<char> borne_bodies(const Model& model, const SubstepEnds& ends);

}  // namespace weft
