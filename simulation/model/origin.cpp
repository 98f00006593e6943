#include "simulation/model/origin.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {

namespace {

struct Extent {
    Vec3 low, high;
    double longest() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

/// Of what has mass. What has none, obstacles and vertices that nothing uses, may be anywhere.
Extent extent_of(const Gathered& all) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    auto& [low, high] = extent;
    for (std::size_t v = 0; v < all.rest.size(); ++v) {
        if (!(all.masses[v] > 0.0)) continue;
        const Vec3 x = all.rest[v];
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    return extent;
}

double power_of_two_above(double value) {
    int exponent = 0;
    std::frexp(value, &exponent);
    return std::ldexp(1.0, exponent);
}

/// What is endless has no place of its own along itself: the nearest one keeps the most digits of
/// where friction holds on.
Vec3 nearest_of_plane(const Frame& frame) {
    const auto& rows = frame.axes.rows;
    const Vec3 up{rows[0].y, rows[1].y, rows[2].y};
    return dot(up, frame.origin) * up;
}

}  // namespace

Vec3 origin_of(const Gathered& all) {
    constexpr double kNear = 8.0;
    const Extent extent = extent_of(all);
    const double size = extent.longest();
    if (!(size > 0.0)) return {};  // no body, or one without any size
    const double unit = power_of_two_above(size);
    const auto coordinate = [&](double low, double high) {
        const double middle = 0.5 * (low + high);
        return std::abs(middle) <= kNear * size ? 0.0 : std::round(middle / unit) * unit;
    };
    const auto& [low, high] = extent;
    return {coordinate(low.x, high.x), coordinate(low.y, high.y), coordinate(low.z, high.z)};
}

void count_from(Vec3 origin, Gathered& all) {
    all.origin = all.origin + origin;
    for (Vec3& x : all.rest) x = x - origin;
    for (MovingPins::Group& group : all.moving) {
        for (Vec3& x : group.rest) x = x - origin;
        for (auto& frame : group.frames) {
            for (Vec3& x : frame) x = x - origin;
        }
        group.motion = counted_from(origin, std::move(group.motion));
    }
}

Motion counted_from(Vec3 origin, Motion motion) {
    motion.center = motion.center - origin;
    if (motion.parent) {
        motion.parent = std::make_shared<const Motion>(counted_from(origin, *motion.parent));
    }
    return motion;
}

Obstacle counted_from(Vec3 origin, Obstacle obstacle) {
    if (origin == Vec3{}) return obstacle;
    obstacle.frame.origin = obstacle.frame.origin - origin;
    if (std::isinf(obstacle.half_width)) obstacle.frame.origin = nearest_of_plane(obstacle.frame);
    if (obstacle.motion) obstacle.motion = counted_from(origin, std::move(*obstacle.motion));
    return obstacle;
}

}  // namespace weft
