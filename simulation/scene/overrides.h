#pragma once

#include <vector>

#include "simulation/scene/document.h"
#include "simulation/scene/read_scene.h"

namespace weft {

/// Writes values given from outside into a parsed scene, in order, before it is checked, so that
/// they are held to the same rules as the file. docs/scenes.md describes the paths. Throws
/// UserError.
void apply_overrides(Node& root, const std::vector<Override>& overrides);

}  // namespace weft
