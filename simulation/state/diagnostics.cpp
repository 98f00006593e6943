#include "simulation/state/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_finite(const float4& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string text_of(Vec3 v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

/// The first of the values that is not as it has to be; -1: all are.
template <class IsGood>
int find_bad(std::span<const float4> values, const IsGood& is_good) {
    const auto bad = std::ranges::find_if_not(values, is_good);
    return bad == values.end() ? -1 : static_cast<int>(bad - values.begin());
}

std::optional<BadState> find_too_fast(const Model& model) {
    const double most = model.scene.guard.max_speed;
    const auto velocities = model.velocities->span();
    const int v = find_bad(velocities, [&](const float4& velocity) {
        const Vec3 u = to_vec3(velocity);
        return dot(u, u) <= most * most;
    });
    if (v < 0) return std::nullopt;
    return BadState{v, fmt::format("velocity {} m/s is beyond guard.max_speed = {:g} m/s",
                                   text_of(to_vec3(velocities[at(v)])), most)};
}

/// Every vertex is one body's.
const BodyRange& body_of(const Model& model, int vertex) {
    const SceneVertex in_scene = model.scene_vertex(vertex);
    return *std::ranges::find_if(model.bodies,
                                 [&](const BodyRange& body) { return body.has(in_scene); });
}

/// Of the vertices of a block.
struct BlockOfVertices {
    bool is_finite = true;
    double kinetic = 0.0;  ///< [J]
    Vec3 moment;           ///< see mass_moment()
    double fastest = 0.0;  ///< squared [m^2/s^2]; of a block that is finite
};

/// A state, and what is found out about it block by block.
class Pass {
public:
    Pass(const Model& model, std::span<const float4> positions, std::span<const float4> velocities,
         double time)
        : model_(model),
          time_(time),
          positions_(positions),
          velocities_(velocities),
          vertices_(at(block_count(model.vertex_count()))) {
        loops_.push_back({model.vertex_count(), [this](int block, int begin, int end) {
                              vertices_[at(block)] = of_vertices(begin, end);
                          }});
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;

    void add_families() {
        for (const auto& family : model_.families) add(*family);
    }

    void add_edges() {
        edges_.resize(at(block_count(model_.edges->count())));
        loops_.push_back({model_.edges->count(), [this](int block, int begin, int end) {
                              edges_[at(block)] =
                                  model_.edges->strain_of_block(at(begin), at(end), positions_);
                          }});
    }

    void run() const { for_each_block(loops_); }

    bool is_finite() const { return std::ranges::all_of(vertices_, &BlockOfVertices::is_finite); }
    /// Squared [m^2/s^2]
    double fastest() const {
        double most = 0.0;
        for (const BlockOfVertices& block : vertices_) most = std::max(most, block.fastest);
        return most;
    }
    Strain strain() const { return model_.edges->joined(edges_); }
    Energies energies(double contact) const {
        Energies energies;
        Vec3 moment;
        for (const BlockOfVertices& block : vertices_) {
            energies.kinetic += block.kinetic;
            moment = moment + block.moment;
        }
        energies.gravity = -dot(model_.scene.gravity_at(time_), moment);
        for (const auto& sums : families_) {
            energies.elements.push_back(std::accumulate(sums.begin(), sums.end(), 0.0));
        }
        if (model_.scene.contact) energies.contact = contact;
        return energies;
    }

private:
    void add(const ElementFamily& family) {
        const std::size_t f = families_.size();
        families_.emplace_back(at(block_count(family.count())));
        loops_.push_back({family.count(), [this, &family, f](int block, int begin, int end) {
                              families_[f][at(block)] =
                                  family.sum_energies_at(time_, begin, end, positions_);
                          }});
    }

    BlockOfVertices of_vertices(int begin, int end) const {
        BlockOfVertices block;
        for (std::size_t v = at(begin); v < at(end); ++v) {
            const Vec3 x = to_vec3(positions_[v]);
            const Vec3 u = to_vec3(velocities_[v]);
            const double square = dot(u, u);
            // Sums of numbers in single precision are finite in double precision, if these are.
            block.is_finite &= std::isfinite(x.x + x.y + x.z + square);
            block.fastest = std::max(block.fastest, square);
            if (positions_[v].w <= 0.0f) continue;  // held vertices are not part of the system
            block.kinetic += 0.5 * model_.masses[v] * square;
            block.moment = block.moment + model_.masses[v] * model_.in_scene(x);
        }
        return block;
    }

    const Model& model_;
    const double time_;  ///< [s]
    std::span<const float4> positions_, velocities_;
    std::vector<BlockOfVertices> vertices_;      ///< [blocks]
    std::vector<Edges::BlockStrain> edges_;      ///< [blocks]
    std::vector<std::vector<double>> families_;  ///< [families, blocks] [J]
    std::vector<BlockLoop> loops_;
};

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
    Pass pass(model, positions, velocities, time);
    pass.add_families();
    pass.run();
    return pass.energies(contact);
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

StateLook look_at_state(const Model& model, double time, double contact, bool with_energies) {
    const auto positions = model.positions->span();
    const Guard& guard = model.scene.guard;
    Pass pass(model, positions, model.velocities->span(), time);
    if (with_energies) pass.add_families();
    pass.add_edges();
    pass.run();
    StateLook look;
    if (!pass.is_finite()) {
        look.non_finite = find_non_finite(model);
        return look;
    }
    look.strain = pass.strain();
    if (with_energies) look.energies = pass.energies(contact);
    if (pass.fastest() > guard.max_speed * guard.max_speed) {
        look.beyond_guard = find_too_fast(model);
    } else {
        look.beyond_guard =
            model.edges->find_overstretched(positions, look.strain, guard.max_strain);
    }
    return look;
}

std::string body_name(const Model& model, int vertex) {
    const BodyRange& body = body_of(model, vertex);
    return fmt::format("{} '{}'", body.kind, body.name);
}

std::string vertex_name(const Model& model, int vertex) {
    const int own = body_of(model, vertex).own(model.scene_vertex(vertex));
    return fmt::format("vertex {} of {}", own, body_name(model, vertex));
}

}  // namespace weft
