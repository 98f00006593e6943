#pragma once

#include <vector>

#include "simulation/scene/keys.h"

/// Parts of the table in keys.h: which vertices of a body are meant. Corners and the like where its
/// shape has some, indices, boxes.
namespace weft {

std::vector<Key> cloth_selection_keys();
std::vector<Key> solid_selection_keys();
/// Of `a`, which may be either.
std::vector<Key> any_selection_keys();

}  // namespace weft
