#include "simulation/scene/motion.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

MotionKey key_at(const std::vector<MotionKey>& keys, double time) {
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const MotionKey& k) { return t < k.time; });
    if (after == keys.begin()) return keys.front();
    if (after == keys.end()) return keys.back();
    const MotionKey& a = *(after - 1);
    const MotionKey& b = *after;
    const double s = (time - a.time) / (b.time - a.time);
    return {time, a.translate + s * (b.translate - a.translate),
            a.rotate + s * (b.rotate - a.rotate)};
}

}  // namespace

Frame Motion::displacement(double time) const {
    const MotionKey key = keys.empty() ? MotionKey{time, time * velocity, time * angular_velocity}
                                       : key_at(keys, time);
    // Exactly no rotation where there is none, so that a pure translation stays one to the bit.
    if (key.rotate == 0.0) return {key.translate, Mat3{}};
    const Mat3 rotation = rotation_matrix(axis, key.rotate);
    return {center - rotation * center + key.translate, rotation};
}

FastestTurn fastest_turn(const Motion& motion) {
    FastestTurn fastest{std::abs(motion.angular_velocity), 0.0};
    for (std::size_t k = 1; k < motion.keys.size(); ++k) {
        const MotionKey& a = motion.keys[k - 1];
        const MotionKey& b = motion.keys[k];
        const double rate = std::abs(b.rotate - a.rotate) / (b.time - a.time);
        if (rate > fastest.rate) fastest = {rate, a.time};
    }
    return fastest;
}

/// The way is affine in the point, so its length is convex, and largest at a corner.
double farthest_move(const Frame& before, const Frame& now, Vec3 half_size) {
    double most = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const auto side = [&](int bit, double half) { return corner & bit ? half : -half; };
        const Vec3 p{side(1, half_size.x), side(2, half_size.y), side(4, half_size.z)};
        most = std::max(most, length(now.to_world(p) - before.to_world(p)));
    }
    return most;
}

Frame moved(const Frame& rest, const std::optional<Motion>& motion, double time) {
    if (!motion) return rest;
    const Frame displacement = motion->displacement(time);
    return {displacement.to_world(rest.origin), displacement.axes * rest.axes};
}

}  // namespace weft
