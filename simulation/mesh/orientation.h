#pragma once

#include "simulation/mesh/vec3.h"

/// Signs that are never wrong: in double precision where its rounding cannot matter, and else as
/// exact sums (Shewchuk 1997). All coordinates are numbers of single precision, as positions are.
namespace weft {

/// On which side of the triangle a, b, c the point p is: 1 where cross(b - a, c - a) points to,
/// -1 on the other side, 0 in its plane, and of a triangle without area.
int side_of(Vec3 a, Vec3 b, Vec3 c, Vec3 p);

/// Which way a, b, c turn as seen against the axis (0: x, 1: y, 2: z): 1 to the left, -1 to the
/// right, 0 where they are in line.
int turn_of(Vec3 a, Vec3 b, Vec3 c, int axis);

}  // namespace weft
