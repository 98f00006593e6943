#pragma once

#include "simulation/model/gathered.h"

namespace weft {

/// Where a model's positions count from, in the scene's own coordinates [m]. Single precision keeps
/// 7 digits: of a sheet of 1 m that is 10 km away, millimetres. So positions count from a place
/// near the bodies, everything that comes in is moved there in double precision, and what goes out
/// is moved back.
///
/// Each coordinate is 0 where the middle of all that has mass is, at its start, within 8 times the
/// longest side of the box around it; else the multiple nearest to the middle of the power of two
/// above that side. So it is exact, moves with the scene, and does not follow every little change.
Vec3 origin_of(const Gathered& all);

/// The same, with positions that count from `origin`.
void count_from(Vec3 origin, Gathered& all);
Motion counted_from(Vec3 origin, Motion motion);
Obstacle counted_from(Vec3 origin, Obstacle obstacle);

}  // namespace weft
