#include "simulation/diagnostics.h"

#include <fmt/format.h>

#include <cmath>

#include "simulation/model/convert.h"

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

/// Attachments are left out: vertices that are tied to each other in one place have no length.
std::optional<BadState> find_overstretched(const Model& model, const Springs& springs) {
    const double most = model.scene.guard.max_strain;
    for (int s = 0; s < springs.elements.count(); ++s) {
        if (!springs.is_edge(s)) continue;
        const auto ends = springs.elements.vertices_of(s);
        const Vec3 along = to_vec3((*model.positions)[static_cast<std::size_t>(ends[0])]) -
                           to_vec3((*model.positions)[static_cast<std::size_t>(ends[1])]);
        const double limit = springs.rest_length(s) * (1.0 + most);
        if (dot(along, along) <= limit * limit) continue;
        return BadState{ends[0], fmt::format("edge of {:g} m is stretched to {:g} m, beyond "
                                             "guard.max_strain = {:g}",
                                             springs.rest_length(s), length(along), most)};
    }
    return std::nullopt;
}

/// Membranes or Tetrahedra.
template <class Kind>
std::optional<BadState> find_overstretched(const Model& model, const Kind& kind, const char* what) {
    const double most = model.scene.guard.max_strain;
    for (int e = 0; e < kind.elements.count(); ++e) {
        const double stretch = kind.stretch(e, model.positions->span());
        if (stretch <= 1.0 + most) continue;
        return BadState{kind.elements.vertices_of(e)[0],
                        fmt::format("{} is stretched to {:g} times its size, beyond "
                                    "guard.max_strain = {:g}",
                                    what, stretch, most)};
    }
    return std::nullopt;
}

std::optional<BadState> find_overstretched(const Model& model) {
    std::optional<BadState> bad;
    if (model.springs) bad = find_overstretched(model, *model.springs);
    if (!bad && model.membranes) bad = find_overstretched(model, *model.membranes, "triangle");
    if (!bad && model.tetrahedra) bad = find_overstretched(model, *model.tetrahedra, "tetrahedron");
    return bad;
}

}  // namespace

std::vector<std::string> energy_names(const Model& model) {
    std::vector<std::string> names;
    if (model.springs) names.push_back("stretch");
    if (model.membranes) names.push_back("membrane");
    if (model.tetrahedra) names.push_back("solid");
    if (model.hinges) names.push_back("bend");
    return names;
}

Energies measure_energies(const Model& model, double time) {
    Energies energies;
    const Vec3 g = model.scene.gravity_at(time);
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        const float4& x = (*model.positions)[v];
        if (x.w <= 0.0f) continue;  // held vertices are not part of the system
        const Vec3 u = to_vec3((*model.velocities)[v]);
        energies.kinetic += 0.5 * model.masses[v] * dot(u, u);
        energies.gravity -= model.masses[v] * dot(g, to_vec3(x));
    }
    const auto add = [&](const auto& kind) {
        if (kind) energies.elements.push_back(kind->energy(model.positions->span()));
    };
    add(model.springs);
    add(model.membranes);
    add(model.tetrahedra);
    add(model.hinges);
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
    const int in_scene = model.strips.order[static_cast<std::size_t>(vertex)];
    for (const BodyRange& body : model.bodies) {
        const int own = in_scene - body.first_vertex;
        if (own >= 0 && own < body.vertex_count) {
            return fmt::format("vertex {} of {} '{}'", own, body.kind, body.name);
        }
    }
    return fmt::format("vertex {}", in_scene);
}

}  // namespace weft
