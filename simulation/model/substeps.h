#pragma once

#include "simulation/model/gathered.h"
#include "simulation/scene/scene.h"

namespace weft {

constexpr double kMostSubsteps = 1000.0;  ///< that are chosen

/// The scene with as many substeps as its meshes and materials need where it does not say how many;
/// where there are too few, a warning.
Scene with_substeps(Scene scene, const Gathered& all, Warnings& warnings);

/// The same, without a word. Reads the scene's meshes where it leaves the number out.
Scene with_substeps(const Scene& scene);

}  // namespace weft
