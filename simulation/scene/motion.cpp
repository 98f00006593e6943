#include "simulation/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft {
namespace {

/// The turn by `degrees` about an axis, as half its angle has it.
struct Turn {
    double real = 1.0;
    Vec3 imaginary{};
};

Turn turn_about(Vec3 axis, double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return {std::cos(half), std::sin(half) * normalized(axis)};
}

double product(const Turn& a, const Turn& b) {
    return a.real * b.real + dot(a.imaginary, b.imaginary);
}

/// [degrees] between two turns, the shortest way.
double angle_between(const Turn& a, const Turn& b) {
    return std::acos(std::min(1.0, std::abs(product(a, b)))) * 360.0 / std::numbers::pi;
}

/// At s in [0, 1] on the way from one turn to another, at constant rate.
Turn between(const Turn& a, Turn b, double s) {
    if (product(a, b) < 0.0) b = {-b.real, -b.imaginary};
    const double angle = std::acos(std::min(1.0, product(a, b)));
    double of_a = 1.0 - s, of_b = s;
    if (angle > 1e-6) {
        of_a = std::sin(of_a * angle) / std::sin(angle);
        of_b = std::sin(of_b * angle) / std::sin(angle);
    }
    return {of_a * a.real + of_b * b.real, of_a * a.imaginary + of_b * b.imaginary};
}

Vec3 axis_of(const MotionKey& key, const Motion& motion) { return key.axis.value_or(motion.axis); }

/// Whether two keys turn about one axis, so that angles may go beyond a half turn.
bool share_axis(const MotionKey& a, const MotionKey& b, const Motion& motion) {
    return a.rotate == 0.0 || b.rotate == 0.0 || axis_of(a, motion) == axis_of(b, motion);
}

/// Its axis is always there.
MotionKey key_between(const MotionKey& a, const MotionKey& b, double time, const Motion& motion) {
    const double s = (time - a.time) / (b.time - a.time);
    const Vec3 translate = a.translate + s * (b.translate - a.translate);
    if (share_axis(a, b, motion)) {
        const Vec3 axis = axis_of(a.rotate == 0.0 ? b : a, motion);
        return {time, translate, a.rotate + s * (b.rotate - a.rotate), axis};
    }
    const Turn turn = between(turn_about(axis_of(a, motion), a.rotate),
                              turn_about(axis_of(b, motion), b.rotate), s);
    const double sine = length(turn.imaginary);
    if (sine == 0.0) return {time, translate, 0.0, motion.axis};
    return {time, translate, std::atan2(sine, turn.real) * 360.0 / std::numbers::pi,
            turn.imaginary};
}

MotionKey key_at(const Motion& motion, double time) {
    const auto& keys = motion.keys;
    const auto after = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const MotionKey& k) { return t < k.time; });
    MotionKey key = after == keys.begin() ? keys.front()
                    : after == keys.end() ? keys.back()
                                          : key_between(*(after - 1), *after, time, motion);
    key.axis = axis_of(key, motion);
    return key;
}

double turn_of(const MotionKey& a, const MotionKey& b, const Motion& motion) {
    if (share_axis(a, b, motion)) return std::abs(b.rotate - a.rotate);
    return angle_between(turn_about(axis_of(a, motion), a.rotate),
                         turn_about(axis_of(b, motion), b.rotate));
}

}  // namespace

Frame Motion::own_displacement(double time) const {
    const MotionKey key = keys.empty()
                              ? MotionKey{time, time * velocity, time * angular_velocity, axis}
                              : key_at(*this, time);
    // Exactly no rotation where there is none, so that a pure translation stays one to the bit.
    if (key.rotate == 0.0) return {key.translate, Mat3{}};
    const Mat3 rotation = rotation_matrix(*key.axis, key.rotate);
    return {center - rotation * center + key.translate, rotation};
}

Frame Motion::displacement(double time) const {
    const Frame own = own_displacement(time);
    if (!parent) return own;
    const Frame carried = parent->displacement(time);
    return {carried.to_world(own.origin), carried.axes * own.axes};
}

FastestTurn fastest_turn(const Motion& motion) {
    FastestTurn fastest{std::abs(motion.angular_velocity), 0.0};
    for (std::size_t k = 1; k < motion.keys.size(); ++k) {
        const MotionKey& a = motion.keys[k - 1];
        const MotionKey& b = motion.keys[k];
        const double rate = turn_of(a, b, motion) / (b.time - a.time);
        if (rate > fastest.rate) fastest = {rate, a.time};
    }
    if (motion.parent) fastest.rate += fastest_turn(*motion.parent).rate;
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
