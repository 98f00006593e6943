#include "simulation/diagnostics.h"

#include <fmt/format.h>

#include <cmath>

#include "simulation/families/convert.h"

namespace weft {

namespace {

bool is_finite(const float4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string text_of(const float4& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

std::optional<BadState> find_too_fast(const Model& model) {
    const double most = model.scene.guard.max_speed;
    for (int v = 0; v < model.vertex_count(); ++v) {
        const float4& velocity = (*model.velocities)[static_cast<std::size_t>(v)];
        if (!is_finite(velocity)) {
            return BadState{v, "velocity " + text_of(velocity) + " m/s is not finite"};
        }
        const Vec3 u = to_vec3(velocity);
        if (dot(u, u) <= most * most) continue;
        return BadState{v, fmt::format("velocity {} m/s is beyond guard.max_speed = {:g} m/s",
                                       text_of(velocity), most)};
    }
    return std::nullopt;
}

std::optional<BadState> find_overstretched(const Model& model) {
    const double most = model.scene.guard.max_strain;
    for (const auto& family : model.families) {
        if (auto bad = family->find_overstretched(model.positions->span(), most)) return bad;
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::string> energy_names(const Model& model) {
    std::vector<std::string> names;
    for (const auto& family : model.families) names.push_back(family->names().energy);
    return names;
}

Energies measure_energies(const Model& model, std::span<const float4> positions,
                          std::span<const float4> velocities, double time) {
    Energies energies;
    const Vec3 g = model.scene.gravity_at(time);
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        const float4& x = positions[v];
        if (x.w <= 0.0f) continue;  // held vertices are not part of the system
        const Vec3 u = to_vec3(velocities[v]);
        energies.kinetic += 0.5 * model.masses[v] * dot(u, u);
        energies.gravity -= model.masses[v] * dot(g, to_vec3(x));
    }
    for (const auto& family : model.families) {
        energies.elements.push_back(family->total_energy(positions));
    }
    return energies;
}

std::optional<BadState> find_non_finite(const Model& model) {
    for (int v = 0; v < model.vertex_count(); ++v) {
        const float4& x = (*model.positions)[static_cast<std::size_t>(v)];
        if (!is_finite(x)) return BadState{v, "position " + text_of(x) + " m is not finite"};
    }
    return std::nullopt;
}

std::optional<BadState> find_bad_state(const Model& model) {
    if (auto bad = find_non_finite(model)) return bad;
    if (auto bad = find_too_fast(model)) return bad;
    return find_overstretched(model);
}

std::string vertex_name(const Model& model, int vertex) {
    const int in_scene = model.scene_vertex(vertex);
    for (const BodyRange& body : model.bodies) {
        const int own = in_scene - body.first_vertex;
        if (own >= 0 && own < body.vertex_count) {
            return fmt::format("vertex {} of {} '{}'", own, body.kind, body.name);
        }
    }
    return fmt::format("vertex {}", in_scene);
}

}  // namespace weft
