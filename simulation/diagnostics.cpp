#include "simulation/diagnostics.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "runtime/tbb/parallel.h"
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
        const Vec3 u = to_vec3(velocity);
        if (dot(u, u) <= most * most) continue;
        return BadState{v, fmt::format("velocity {} m/s is beyond guard.max_speed = {:g} m/s",
                                       text_of(velocity), most)};
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::string> energy_names(const Model& model) {
    std::vector<std::string> names;
    for (const auto& family : model.families) names.push_back(family->names().energy);
    return names;
}

double Energies::strain() const { return std::accumulate(elements.begin(), elements.end(), 0.0); }

Energies measure_energies(const Model& model, std::span<const float4> positions,
                          std::span<const float4> velocities, double time) {
    Energies energies;
    energies.gravity = -dot(model.scene.gravity_at(time), mass_moment(model, positions));
    energies.kinetic = sum_of_blocks(model.vertex_count(), [&](int begin, int end) {
        double sum = 0.0;
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
            if (positions[v].w <= 0.0f) continue;  // held vertices are not part of the system
            const Vec3 u = to_vec3(velocities[v]);
            sum += 0.5 * model.masses[v] * dot(u, u);
        }
        return sum;
    });
    for (const auto& family : model.families) {
        energies.elements.push_back(family->total_energy(positions));
    }
    return energies;
}

Vec3 mass_moment(const Model& model, std::span<const float4> positions) {
    Vec3 sum;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (positions[v].w > 0.0f) sum = sum + model.masses[v] * to_vec3(positions[v]);
    }
    return sum;
}

std::optional<BadState> find_non_finite(const Model& model) {
    for (int v = 0; v < model.vertex_count(); ++v) {
        const float4& x = (*model.positions)[static_cast<std::size_t>(v)];
        if (!is_finite(x)) return BadState{v, "position " + text_of(x) + " m is not finite"};
        const float4& u = (*model.velocities)[static_cast<std::size_t>(v)];
        if (!is_finite(u)) return BadState{v, "velocity " + text_of(u) + " m/s is not finite"};
    }
    return std::nullopt;
}

std::optional<BadState> find_beyond_guard(const Model& model, const Strain& strain) {
    if (auto bad = find_too_fast(model)) return bad;
    return model.edges->find_overstretched(model.positions->span(), strain,
                                           model.scene.guard.max_strain);
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
