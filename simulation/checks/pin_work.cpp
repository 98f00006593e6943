#include "simulation/checks/pin_work.h"

#include <algorithm>
#include <cmath>

#include "simulation/checks/pin_twist.h"
#include "simulation/families/convert.h"
#include "simulation/model/model.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Whether nothing is held but by pins that move.
bool all_held_move(const Model& model) {
    std::size_t held = 0;
    for (const float4& x : model.positions->span()) held += x.w <= 0.0f ? 1 : 0;
    return held == model.moving_pins->count();
}

/// Whether an obstacle may have pushed something within a frame that ends at `end` [s]: it is no
/// farther than the way that either has gone.
bool is_touched(const Model& model, const SimulationState& before, double start, double end) {
    const auto now = model.positions->span();
    for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
        const Obstacle& obstacle = model.convex_obstacles[o];
        const Frame from = obstacle.frame_at(start);
        const Frame to = obstacle.frame_at(end);
        const double moved = farthest_move(from, to, obstacle.half_size);
        for (std::size_t v = 0; v < now.size(); ++v) {
            const double way = length(to_vec3(now[v]) - to_vec3(before.positions[v])) + moved;
            const double apart = length(to_vec3(now[v]) - to.origin);
            if (now[v].w <= 0.0f || apart > model.obstacles->reach(o) + way) continue;
            if (model.obstacles->touches(o, to, static_cast<int>(v), now, way)) return true;
        }
    }
    return false;
}

/// What damping has left of a velocity after so many substeps, as a part of what it took.
double damped_by(const float4& velocity, int substeps) {
    return substeps * (1.0 / static_cast<double>(velocity.w) - 1.0);
}

OutsideWork work_of_push(const Model& model, const SimulationState& before, Vec3 velocity,
                         int substeps) {
    Vec3 fall;  // [m/s]
    for (int s = 0; s < substeps; ++s) fall = fall + model.h * to_vec3((*model.gravity)[at(s)]);
    Vec3 push, unknown;
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        if ((*model.positions)[v].w <= 0.0f) continue;
        const Vec3 first = to_vec3(before.velocities[v]);
        const float4& last = (*model.velocities)[v];
        const Vec3 gained = to_vec3(last) - first;
        // What damping leaves of a velocity per substep, and what velocities it had between.
        const double damped = damped_by(last, substeps);
        push = push + model.masses[v] * (gained - fall + 0.5 * damped * (first + to_vec3(last)));
        unknown = unknown + (model.masses[v] * damped) * gained;
    }
    return {dot(velocity, push), length(velocity) * length(unknown)};
}

/// What turning pins have given to everything else in a frame, but for gravity's part.
struct Given {
    Vec3 momentum;         ///< [kg m/s]
    double spin = 0.0;     ///< angular momentum about the axis [kg m^2/s]
    double damped = 0.0;   ///< of it, what damping might have taken more or less of
    double turning = 0.0;  ///< twice the energy of motion around the axis, on average [J]
    double mass = 0.0;     ///< [kg]
    Vec3 first, last;      ///< sums of mass times place from the center [kg m]
    double radius = 0.0;   ///< of the pin farthest from the axis [m]
};

Given given_by(const Model& model, const SimulationState& before, const Twist& twist,
               int substeps) {
    Given sum;
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        const float4& x = (*model.positions)[v];
        const Vec3 to = to_vec3(x) - twist.center;
        if (x.w <= 0.0f) {
            sum.radius = std::max(sum.radius, length(cross(twist.axis, to)));
            continue;
        }
        const Vec3 from = to_vec3(before.positions[v]) - twist.center;
        const Vec3 slow = to_vec3(before.velocities[v]);
        const float4& last = (*model.velocities)[v];
        const Vec3 fast = to_vec3(last);
        const double mass = model.masses[v];
        const double damped = damped_by(last, substeps);
        const double old_spin = dot(twist.axis, cross(from, slow));
        const double new_spin = dot(twist.axis, cross(to, fast));
        sum.momentum = sum.momentum + mass * (fast - slow + 0.5 * damped * (slow + fast));
        sum.spin += mass * (new_spin - old_spin + 0.5 * damped * (old_spin + new_spin));
        sum.damped += mass * damped * std::abs(new_spin - old_spin);
        const Vec3 old_across = cross(twist.axis, slow);
        const Vec3 new_across = cross(twist.axis, fast);
        sum.turning += 0.5 * mass * (dot(old_across, old_across) + dot(new_across, new_across));
        sum.mass += mass;
        sum.first = sum.first + mass * from;
        sum.last = sum.last + mass * to;
    }
    return sum;
}

/// Forces act where a substep ends, r from the center, and pins go there from R^-1 r: by
/// sin(angle) axis x r, which goes with their torque, by (1 - cos(angle)) r across the axis, and
/// along it. Motion in a circle, stepped implicitly, loses angular momentum: by h m v x v' in a
/// substep from v to v', which is what pins have to give beside what is gained. How much of that
/// there is, and how much the second part takes back, depends on who goes in a circle: half.
OutsideWork work_of_turn(const Model& model, const SimulationState& before, const Twist& twist,
                         int substeps) {
    Given given = given_by(model, before, twist, substeps);
    const double h = model.h;
    const double time = substeps * h;
    Vec3 fall;  // [m/s]
    for (int s = 0; s < substeps; ++s) {
        const Vec3 gravity = to_vec3((*model.gravity)[at(s)]);
        const double part = (s + 1.0) / substeps;
        const Vec3 moment = (1.0 - part) * given.first + part * given.last;
        given.spin -= h * dot(twist.axis, cross(moment, gravity));
        fall = fall + h * gravity;
    }
    const Vec3 push = given.momentum - given.mass * fall;
    const double per_spin = std::sin(twist.angle) / h;
    const double circling = substeps * twist.angle * twist.angle * given.turning;
    OutsideWork sum;
    sum.work = per_spin * given.spin + twist.slide / h * dot(twist.axis, push) + 0.5 * circling;
    // Where the middle of everything was within the frame; what pulls at the pins.
    const double bent = 0.125 * time * length(given.momentum) * length(fall);
    const double pulled = (1.0 - std::cos(twist.angle)) / h * given.radius * length(push);
    sum.doubt = per_spin * (given.damped + bent) + 0.5 * circling + pulled;
    return sum;
}

}  // namespace

std::optional<OutsideWork> work_of_pins(const Model& model, const SimulationState& before,
                                        double start, double end) {
    if (!model.moving_pins || !all_held_move(model)) return std::nullopt;
    if (model.obstacles && is_touched(model, before, start, end)) return std::nullopt;
    const int substeps = static_cast<int>(std::lround((end - start) / model.h));
    if (const auto velocity = model.moving_pins->common_velocity(start, model.h, substeps)) {
        return work_of_push(model, before, *velocity, substeps);
    }
    auto twist = common_twist(model.scene, start, model.h, substeps);
    if (!twist) return std::nullopt;
    twist->center = twist->center - model.origin;
    return work_of_turn(model, before, *twist, substeps);
}

}  // namespace weft
