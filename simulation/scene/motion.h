#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft {

/// A rigid placement: world = origin + axes * local. The columns of `axes` are the local axes.
struct Frame {
    Vec3 origin;
    Mat3 axes;

    Vec3 to_world(Vec3 local) const { return origin + axes * local; }
    Vec3 to_local(Vec3 world) const { return transposed(axes) * (world - origin); }
    friend bool operator==(const Frame&, const Frame&) = default;
};

/// Where a motion has got to at one time. Held before the first key and after the last.
struct MotionKey {
    double time = 0.0;    ///< [s]
    Vec3 translate{};     ///< [m]
    double rotate = 0.0;  ///< [degrees] about the axis
    /// Absent: the motion's. Between keys of two axes the turn goes the shortest way.
    std::optional<Vec3> axis{};

    friend bool operator==(const MotionKey&, const MotionKey&) = default;
};

/// A prescribed rigid motion, of an obstacle or of pins, relative to the place at time 0:
/// p(t) = center + R(axis, angle(t)) (p(0) - center) + translation(t).
/// Either keys (linear between them) or constant velocities, never both.
struct Motion {
    Vec3 velocity{};                ///< [m/s]
    double angular_velocity = 0.0;  ///< [degrees/s] about `axis` through `center`
    Vec3 axis{0.0, 1.0, 0.0};
    Vec3 center{};                  ///< [m], moves with the translation
    std::vector<MotionKey> keys{};  ///< by rising time; empty: constant velocities
    /// That carries all of this along; null: none.
    std::shared_ptr<const Motion> parent{};

    /// The motion as a map of the world at time 0 to the world at `time` [s]:
    /// p(time) = displacement(time).to_world(p(0)).
    Frame displacement(double time) const;

    /// By what was written. Parents are equal if they are one.
    friend bool operator==(const Motion&, const Motion&) = default;

private:
    Frame own_displacement(double time) const;
};

/// The fastest turn of a motion.
struct FastestTurn {
    double rate = 0.0;  ///< [degrees/s], >= 0
    double time = 0.0;  ///< when it begins [s]
};
FastestTurn fastest_turn(const Motion& motion);

/// How far the point that moves the farthest goes, of a box around the local origin, from one place
/// to another [m].
double farthest_move(const Frame& before, const Frame& now, Vec3 half_size);

/// The place at `time` of something that is at `rest` at time 0.
Frame moved(const Frame& rest, const std::optional<Motion>& motion, double time);

}  // namespace weft
