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

std::string text_of(Vec3 v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

/// The first of the values that is not as it has to be; -1: all are.
template <class IsGood>
int find_bad(std::span<const float4> values, const IsGood& is_good) {
    return first_of_blocks(static_cast<int>(values.size()), [&](int begin, int end) {
        for (int v = begin; v < end; ++v) {
            if (!is_good(values[static_cast<std::size_t>(v)])) return v;
        }
        return -1;
    });
}

std::optional<BadState> find_too_fast(const Model& model) {
    const double most = model.scene.guard.max_speed;
    const auto velocities = model.velocities->span();
    const int v = find_bad(velocities, [&](const float4& velocity) {
        const Vec3 u = to_vec3(velocity);
        return dot(u, u) <= most * most;
    });
    if (v < 0) return std::nullopt;
    return BadState{v,
                    fmt::format("velocity {} m/s is beyond guard.max_speed = {:g} m/s",
                                text_of(to_vec3(velocities[static_cast<std::size_t>(v)])), most)};
}

}  // namespace

std::vector<std::string> energy_names(const Model& model) {
    std::vector<std::string> names;
    for (const auto& family : model.families) names.push_back(family->names().energy);
    if (model.scene.contact) names.emplace_back("contact");
    return names;
}

double Energies::strain() const {
    return std::accumulate(elements.begin(), elements.end(), contact.value_or(0.0));
}

std::vector<double> Energies::parts() const {
    std::vector<double> parts = elements;
    if (contact) parts.push_back(*contact);
    return parts;
}

Energies measure_energies(const Model& model, std::span<const float4> positions,
                          std::span<const float4> velocities, double time, double contact) {
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
    if (model.scene.contact) energies.contact = contact;
    return energies;
}

Vec3 mass_moment(const Model& model, std::span<const float4> positions) {
    const int count = static_cast<int>(positions.size());
    std::vector<Vec3> sums(static_cast<std::size_t>(block_count(count)));
    for_each_block(count, [&](int block, int begin, int end) {
        Vec3 sum;
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
            if (positions[v].w <= 0.0f) continue;
            sum = sum + model.masses[v] * model.in_scene(to_vec3(positions[v]));
        }
        sums[static_cast<std::size_t>(block)] = sum;
    });
    return std::accumulate(sums.begin(), sums.end(), Vec3{});
}

std::optional<BadState> find_non_finite(const Model& model) {
    const auto positions = model.positions->span(), velocities = model.velocities->span();
    const int x = find_bad(positions, is_finite), u = find_bad(velocities, is_finite);
    if (x >= 0 && (u < 0 || x <= u)) {
        const Vec3 from_origin = to_vec3(positions[static_cast<std::size_t>(x)]);
        const std::string place = text_of(model.in_scene(from_origin));
        return BadState{x, "position " + place + " m is not finite"};
    }
    if (u < 0) return std::nullopt;
    const std::string velocity = text_of(to_vec3(velocities[static_cast<std::size_t>(u)]));
    return BadState{u, "velocity " + velocity + " m/s is not finite"};
}

std::optional<BadState> find_beyond_guard(const Model& model, const Strain& strain) {
    if (auto bad = find_too_fast(model)) return bad;
    return model.edges->find_overstretched(model.positions->span(), strain,
                                           model.scene.guard.max_strain);
}

std::string vertex_name(const Model& model, int vertex) {
    const SceneVertex in_scene = model.scene_vertex(vertex);
    for (const BodyRange& body : model.bodies) {
        if (!body.has(in_scene)) continue;
        return fmt::format("vertex {} of {} '{}'", body.own(in_scene), body.kind, body.name);
    }
    return fmt::format("vertex {}", index(in_scene));
}

}  // namespace weft
