#pragma once

#include <string>
#include <vector>

#include "simulation/scene/document.h"
#include "simulation/scene/keys.h"
#include "simulation/scene/scene.h"

namespace weft {

/// One obstacle shape as scenes know it: its name, its keys, and how they become a frame and
/// dimensions. A new shape is one entry in obstacle_shapes.cpp, of the same name as in
/// kernels/obstacles/shapes.h.
struct ObstacleShape {
    std::string name;
    std::vector<Key> keys;
    /// Sets frame, dimensions, half_width and half_size from the checked table. Throws UserError.
    void (*read)(const Node& table, Obstacle& obstacle);
};

const std::vector<ObstacleShape>& obstacle_shapes();

}  // namespace weft
