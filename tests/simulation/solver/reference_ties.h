#pragma once

#include <vector>

#include "simulation/model/model.h"

namespace weft::test {

/// What soft ties make of where a substep begins (kernels/bodies/ties.h), once more: in double
/// precision, on matrices of six rows. For springs between parts that are held and parts that are
/// not.
/// x       [vertices] new order [m]; those of parts are moved
/// target  [vertices] x~
void lead_parts(const Model& model, std::vector<Vec3>& x, const std::vector<Vec3>& target);

}  // namespace weft::test
