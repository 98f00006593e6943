#pragma once

#include "simulation/topology/layout.h"
#include "simulation/topology/strips.h"
#include "tests/simulation/topology/meshes.h"

namespace weft::test {

// Independent checks by brute force, straight from what the headers promise. They report through
// GoogleTest's expectations.

void expect_valid_strips(const TopologyMesh& mesh, const Strips& strips, int extra_levels = 0);
void expect_valid_layout(const Stencils& kind, const Strips& strips, const ElementLayout& layout);

}  // namespace weft::test
