#pragma once

#include <string>
#include <vector>

#include "simulation/scene/keys.h"

/// Parts of the table in keys.h: what cloths and solids are described by.
namespace weft {

inline constexpr Range kLength = between(1e-6, 1e6);  ///< [m]
inline constexpr Range kPlace = between(-1e6, 1e6);   ///< [m]

/// What an elastic material is made of.
const Key& young_key();
const Key& poisson_key();
/// How an obstacle or a group of pins moves.
Key motion_key(std::string help);

/// What the shape "mesh" of an obstacle adds to what all have.
std::vector<Key> mesh_obstacle_keys();

const TableKeys& cloth_table();
const TableKeys& solid_table();

}  // namespace weft
