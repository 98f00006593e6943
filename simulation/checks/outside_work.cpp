#include "simulation/checks/outside_work.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "runtime/tbb/parallel.h"
#include "simulation/checks/pin_work.h"
#include "simulation/families/convert.h"
#include "simulation/state/diagnostics.h"

namespace weft {

namespace {

constexpr double kTouch = 1e-4;  ///< [m] from where an obstacle keeps a vertex

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What leads a vertex along. A byte each: most elements are passed over by these alone.
enum class Led : std::uint8_t { kNot, kByPin, kByObstacle };

/// The vertices that something leads, and where.
class Leads {
public:
    /// with_pins: by those that move, too
    Leads(const Model& model, const SimulationState& before, double start, double end,
          bool with_pins)
        : model_(model),
          before_(before.positions),
          now_(model.positions->span()),
          velocities_(before.velocities),
          time_(end - start) {
        if (model.moving_pins && with_pins) lead_by_pins();
        for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
            const Frame from = model.convex_obstacles[o].frame_at(start);
            const Frame to = model.convex_obstacles[o].frame_at(end);
            if (!(from == to)) lead_by(o, from, to);
        }
    }

    bool is_any() const {
        return std::ranges::any_of(led_, [](Led led) { return led != Led::kNot; });
    }

    bool is_pinned() const {
        return std::ranges::any_of(led_, [](Led led) { return led == Led::kByPin; });
    }

    double work(Vec3 gravity) const {
        double sum = of_vertices(gravity);
        for (const auto& family : model_.families) sum += of_elements(*family);
        return sum;
    }

private:
    /// lead_one(vertex): fills in where it is led, if it is.
    template <class LeadOne>
    void lead_all(const LeadOne& lead_one) {
        led_.resize(now_.size());
        by_.resize(now_.size());
        for_each_block(model_.vertex_count(), [&](int /*block*/, int begin, int end) {
            for (int v = begin; v < end; ++v) lead_one(at(v));
        });
    }

    void lead_by_pins() {
        lead_all([&](std::size_t v) {
            if (now_[v].w != 0.0f) return;
            by_[v] = to_vec3(now_[v]) - to_vec3(before_[v]);
            if (!(by_[v] == Vec3{})) led_[v] = Led::kByPin;
        });
    }

    void lead_by(std::size_t number, const Frame& from, const Frame& to) {
        const Obstacle& obstacle = model_.convex_obstacles[number];
        const double reach = model_.obstacles->reach(number) + kTouch;
        lead_all([&](std::size_t v) {
            if (now_[v].w == 0.0f) return;
            const Vec3 place = to_vec3(now_[v]);
            const Vec3 apart = place - to.origin;
            if (dot(apart, apart) > reach * reach) return;
            if (!model_.obstacles->touches(number, to, static_cast<int>(v), now_, kTouch)) return;
            const Vec3 local = to.to_local(place);
            by_[v] = place - from.to_world(local);
            if (!obstacle.friction)
                by_[v] = along(to.axes * normal_at_local(obstacle, local), by_[v]);
            led_[v] = Led::kByObstacle;
        });
    }

    /// What does not rub pushes along its normal only.
    static Vec3 along(Vec3 normal, Vec3 way) { return dot(normal, way) * normal; }

    /// What is pushed is lifted, and what is rubbed or hit takes up speed.
    double of_vertices(Vec3 gravity) const {
        double sum = 0.0;
        for (std::size_t v = 0; v < led_.size(); ++v) {
            if (led_[v] != Led::kByObstacle) continue;
            const Vec3 gained = to_vec3((*model_.velocities)[v]) - to_vec3(velocities_[v]);
            sum += model_.masses[v] * dot((1.0 / time_) * gained - gravity, by_[v]);
        }
        return sum;
    }

    double of_elements(const ElementFamily& family) const {
        return sum_of_blocks(family.count(), [&](int begin, int end) {
            double sum = 0.0;
            for (int e = begin; e < end; ++e) sum += of_element(family, e);
            return sum;
        });
    }

    double of_element(const ElementFamily& family, int element) const {
        const auto corners = family.corners(element);
        const auto is_led = [&](int v) { return led_[at(v)] != Led::kNot; };
        if (std::ranges::none_of(corners, is_led)) return 0.0;
        std::array<Vec3, kMaxCorners> first{}, last{};
        family.gradient(element, family.positions_of(element, before_).data(), first.data());
        family.gradient(element, family.positions_of(element, now_).data(), last.data());
        double sum = 0.0;
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const std::size_t v = at(corners[k]);
            if (led_[v] == Led::kNot) continue;
            // What touches an obstacle at the end need not have done so at the start.
            const bool is_held = led_[v] == Led::kByPin;
            sum += dot(is_held ? 0.5 * (first[k] + last[k]) : last[k], by_[v]);
        }
        return sum;
    }

    const Model& model_;
    std::span<const float4> before_, now_;
    std::span<const float4> velocities_;  ///< before
    double time_;                         ///< of the frame [s]
    std::vector<Led> led_;                ///< [vertices]; empty: none
    std::vector<Vec3> by_;                ///< [vertices] in the frame [m]
};

OutsideWork work_of_gravity(const Model& model, std::span<const float4> before,
                            std::span<const float4> now, Vec3 change) {
    OutsideWork sum;
    if (change == Vec3{}) return sum;
    sum.work = -0.5 * dot(change, mass_moment(model, before) + mass_moment(model, now));
    const Vec3 way = mass_moment(model, now) - mass_moment(model, before);
    sum.doubt = length(change) * length(way);
    return sum;
}

Vec3 momentum(const Model& model, std::span<const float4> velocities) {
    Vec3 sum;
    for (std::size_t v = 0; v < velocities.size(); ++v) {
        if ((*model.positions)[v].w > 0.0f) sum = sum + model.masses[v] * to_vec3(velocities[v]);
    }
    return sum;
}

/// [m/s] of the fastest point of an obstacle.
double fastest_obstacle(const Scene& scene, double start, double end) {
    double most = 0.0;
    for (const Obstacle& o : scene.obstacles) {
        most = std::max(most, farthest_move(o.frame_at(start), o.frame_at(end), o.half_size));
    }
    return most / (end - start);
}

/// A blow gives momentum, and at most so much times the obstacle's speed of energy, also to what no
/// longer touches it at the frame's end.
double doubt_of_blows(const Model& model, const SimulationState& before, double start, double end) {
    const double speed = fastest_obstacle(model.scene, start, end);
    if (speed == 0.0) return 0.0;
    double mass = 0.0;
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        if ((*model.positions)[v].w > 0.0f) mass += model.masses[v];
    }
    const Vec3 fallen = mass * (end - start) * model.scene.gravity_at(end);
    const Vec3 gained =
        momentum(model, model.velocities->span()) - momentum(model, before.velocities);
    return speed * length(gained - fallen);
}

/// Of the work of what is led. Corners of triangles that narrow obstacles push may be pulled either
/// way in the end: what they seem to have taken back is no less in doubt than what they gave.
double part_in_doubt(const Model& model, double led) {
    const bool has_narrow = model.obstacles && model.obstacles->narrow() != nullptr;
    return has_narrow && led < 0.0 ? 1.0 : 0.5;
}

}  // namespace

OutsideWork outside_work(const Model& model, const SimulationState& before, double start,
                         double end) {
    const auto now = model.positions->span();
    const Vec3 gravity = model.scene.gravity_at(end);
    OutsideWork sum =
        work_of_gravity(model, before.positions, now, gravity - model.scene.gravity_at(start));
    const auto exact = work_of_pins(model, before, start, end);
    if (exact) {
        sum.work += exact->work;
        sum.doubt += exact->doubt;
    }
    const Leads leads(model, before, start, end, !exact);
    const double led = leads.is_any() ? leads.work(gravity) : 0.0;
    sum.work += led;
    // Forces at a frame's ends say little of those within it, where stiff elements swing in every
    // substep: what pins do may be far more.
    if (leads.is_pinned()) sum.doubt = std::numeric_limits<double>::infinity();
    sum.doubt += part_in_doubt(model, led) * std::abs(led);
    sum.doubt += doubt_of_blows(model, before, start, end);
    return sum;
}

}  // namespace weft
