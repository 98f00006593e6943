#include "simulation/scene/motion.h"

#include <algorithm>

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

Frame moved(const Frame& rest, const std::optional<Motion>& motion, double time) {
    if (!motion) return rest;
    const Frame displacement = motion->displacement(time);
    return {displacement.to_world(rest.origin), displacement.axes * rest.axes};
}

}  // namespace weft
