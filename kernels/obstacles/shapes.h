#ifndef WEFT_KERNELS_OBSTACLES_SHAPES_H
#define WEFT_KERNELS_OBSTACLES_SHAPES_H

// All obstacle shapes: the one list that kernels, launches and the double-precision run go by.
// Their keys in scenes are in simulation/scene/obstacle_shapes.cpp.

#include "kernels/obstacles/box.h"
#include "kernels/obstacles/capsule.h"
#include "kernels/obstacles/plane.h"
#include "kernels/obstacles/sphere.h"

#define WEFT_FOR_EACH_OBSTACLE_SHAPE(visit) visit(sphere) visit(plane) visit(capsule) visit(box)

// Their numbers in obstacles' rows.
#define WEFT_OBSTACLE_sphere 0.0f
#define WEFT_OBSTACLE_plane 1.0f
#define WEFT_OBSTACLE_capsule 2.0f
#define WEFT_OBSTACLE_box 3.0f

#endif
