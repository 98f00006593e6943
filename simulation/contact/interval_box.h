#pragma once

#include <algorithm>
#include <limits>

#include "simulation/mesh/vec3.h"

namespace weft {

/// All points, or velocities, with coordinates between two corners'. Begins as empty.
struct IntervalBox {
    static constexpr double kFar = std::numeric_limits<double>::max();
    Vec3 low{kFar, kFar, kFar};
    Vec3 high{-kFar, -kFar, -kFar};

    void include(const IntervalBox& b) {
        low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
        high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
    }
    void include(Vec3 p) { include(IntervalBox{p, p}); }
    IntervalBox grown(double by) const { return {low - Vec3{by, by, by}, high + Vec3{by, by, by}}; }
};

/// Of all sums of a point of each.
inline IntervalBox operator+(const IntervalBox& a, const IntervalBox& b) {
    return {a.low + b.low, a.high + b.high};
}
inline IntervalBox operator*(double s, const IntervalBox& a) { return {s * a.low, s * a.high}; }

/// From nothing to all of a way.
inline IntervalBox up_to(Vec3 way) {
    IntervalBox box;
    box.include(Vec3{});
    box.include(way);
    return box;
}

/// What is in both; empty, with corners the wrong way round, where they are apart.
inline IntervalBox common(const IntervalBox& a, const IntervalBox& b) {
    return {
        {std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
        {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
}

/// How far two boxes are apart along the axis along which they are farthest; not above 0: nowhere.
inline double gap_between(const IntervalBox& a, const IntervalBox& b) {
    const Vec3 above = a.low - b.high;
    const Vec3 below = b.low - a.high;
    return std::max({above.x, above.y, above.z, below.x, below.y, below.z});
}

/// The length of the longest vector from a point to one of the box.
inline double farthest_from(Vec3 point, const IntervalBox& box) {
    const Vec3 a = box.low - point;
    const Vec3 b = box.high - point;
    return length({std::max(std::abs(a.x), std::abs(b.x)), std::max(std::abs(a.y), std::abs(b.y)),
                   std::max(std::abs(a.z), std::abs(b.z))});
}

}  // namespace weft
