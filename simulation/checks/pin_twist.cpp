#include "simulation/checks/pin_twist.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/scene/scene.h"

namespace weft {

namespace {

/// Of all that is led; none: something is led in another way.
std::optional<std::vector<Motion>> motions_of(const Scene& scene) {
    std::vector<Motion> motions;
    const auto add = [&](const std::vector<PinGroup>& groups) {
        for (const PinGroup& pins : groups) {
            if (pins.motion) motions.push_back(*pins.motion);
        }
    };
    for (const Cloth& cloth : scene.cloths) add(cloth.pins);
    for (const Solid& solid : scene.solids) add(solid.pins);
    for (const MeshObstacle& obstacle : scene.mesh_obstacles) {
        if (!obstacle.frames.empty()) return std::nullopt;
        if (obstacle.motion) motions.push_back(*obstacle.motion);
    }
    return motions;
}

/// From one place to another.
Frame step_between(const Frame& before, const Frame& now) {
    Frame step;
    step.axes = now.axes * transposed(before.axes);
    step.origin = now.origin - step.axes * before.origin;
    return step;
}

/// Up to what the rounding of double precision makes of differences.
bool is_same(const Frame& a, const Frame& b) {
    constexpr double kSame = 1e-9;
    double turned = 0.0;
    for (std::size_t k = 0; k < 3; ++k) turned += length(a.axes.rows[k] - b.axes.rows[k]);
    return turned <= kSame && length(a.origin - b.origin) <= kSame * (1.0 + length(a.origin));
}

std::optional<Twist> twist_of(const Frame& step) {
    constexpr double kNone = 1e-6;  // [rad]
    const auto& r = step.axes.rows;
    // Twice the sine of the angle, along the axis.
    const Vec3 twice{r[2].y - r[1].z, r[0].z - r[2].x, r[1].x - r[0].y};
    const double sine = 0.5 * length(twice);
    const double cosine = 0.5 * (r[0].x + r[1].y + r[2].z - 1.0);
    if (sine <= kNone) return std::nullopt;
    Twist twist;
    twist.axis = (0.5 / sine) * twice;
    twist.angle = std::atan2(sine, cosine);
    twist.slide = dot(step.origin, twist.axis);
    // What stays is where the turn takes back the way across.
    const Vec3 across = step.origin - twist.slide * twist.axis;
    twist.center = 0.5 * (across + (sine / (1.0 - cosine)) * cross(twist.axis, across));
    return twist;
}

}  // namespace

std::optional<Twist> common_twist(const Scene& scene, double time, double h, int substeps) {
    const auto motions = motions_of(scene);
    if (!motions || motions->empty()) return std::nullopt;
    std::optional<Frame> common;
    for (const Motion& motion : *motions) {
        Frame before = motion.displacement(time);
        for (int substep = 1; substep <= substeps; ++substep) {
            const Frame now = motion.displacement(time + substep * h);
            const Frame step = step_between(before, now);
            if (!common) common = step;
            if (!is_same(step, *common)) return std::nullopt;
            before = now;
        }
    }
    return twist_of(*common);
}

}  // namespace weft
