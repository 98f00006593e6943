#include "simulation/checks/body_accounts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/checks/energy_limits.h"
#include "simulation/checks/start_checks.h"
#include "simulation/families/convert.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

constexpr long kEvery = 8;  ///< frames

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_each_alone(const Model& model) {
    const Scene& scene = model.scene;
    const auto moves = [](const Obstacle& obstacle) { return obstacle.motion.has_value(); };
    return !scene.contact && scene.gravity_keys.empty() && scene.seams.empty() &&
           !model.moving_pins && std::ranges::none_of(model.convex_obstacles, moves);
}

}  // namespace

BodyAccounts::BodyAccounts(const Model& model) {
    if (!is_each_alone(model)) return;
    begins_ = component_begins(model.vertex_count(), model.stencils());
    if (body_count() < 2) return;
    inside_ = energy_inside_obstacles(model);
    for (std::size_t body = 0; body < body_count(); ++body)
        lift_.push_back(lift_by_size(model, begins_[body], begins_[body + 1]));
    forgive(measure(model));
}

std::size_t BodyAccounts::body_of(int vertex) const {
    const auto next = std::ranges::upper_bound(begins_, vertex);
    return static_cast<std::size_t>(next - begins_.begin()) - 1;
}

std::vector<BodyAccounts::Energy> BodyAccounts::measure(const Model& model, double end) const {
    if (lift_.empty() || std::lround(end / model.scene.dt) % kEvery != 0) return {};
    return measure(model);
}

std::vector<BodyAccounts::Energy> BodyAccounts::measure(const Model& model) const {
    const auto positions = model.positions->span();
    const Vec3 gravity = model.scene.gravity_at(0.0);
    std::vector<Energy> now(body_count());
    for (std::size_t b = 0; b < body_count(); ++b) {
        Energy& body = now[b];
        for (std::size_t v = at(begins_[b]); v < at(begins_[b + 1]); ++v) {
            if (positions[v].w <= 0.0f) continue;
            const Vec3 u = to_vec3((*model.velocities)[v]);
            const Vec3 x = model.in_scene(to_vec3(positions[v]));
            body.kinetic += 0.5 * model.masses[v] * dot(u, u);
            body.potential -= model.masses[v] * dot(gravity, x);
        }
    }
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const double energy = family->energy(e, family->positions_of(e, positions).data());
            now[body_of(family->corners(e)[0])].strain += energy;
        }
    }
    return now;
}

std::optional<EnergyAlarm> BodyAccounts::look(const Model& model,
                                              const std::vector<Energy>& now) const {
    for (std::size_t body = 0; body < now.size(); ++body) {
        const double left = start_[body] - now[body].potential;
        const double had = std::max(left, 0.0);
        const double lifted = std::max(-left, 0.0);
        const auto is_fine = [&](double excused) {
            return now[body].kinetic <= kMostMotion * (had + kSmallFall * lift_[body] + excused) &&
                   lifted <= kSmallLift * lift_[body] + excused;
        };
        if (is_fine(inside_)) continue;
        const double excused = inside_ + energy_of_rounding(model);
        if (is_fine(excused)) continue;
        const double enough = had + kSmallFall * lift_[body] + excused;
        return EnergyAlarm{
            fmt::format("energy from nowhere: {} has {:.3g} J of motion and {:.3g} J of strain, {}",
                        body_name(model, begins_[body]), now[body].kinetic, now[body].strain,
                        there_was(had, lifted)),
            now[body].kinetic > kExplodingMotion * enough};
    }
    return std::nullopt;
}

void BodyAccounts::forgive(const std::vector<Energy>& now) {
    if (now.empty()) return;
    start_.clear();
    for (const Energy& body : now) start_.push_back(body.total());
}

}  // namespace weft
