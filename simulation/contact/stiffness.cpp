#include "simulation/contact/stiffness.h"

#include <algorithm>

#include "simulation/contact/knots.h"
#include "simulation/families/convert.h"
#include "simulation/model/rest_stiffness.h"

namespace weft {

namespace {

constexpr double kHeld = 1e30;

/// What is hard has at least so many m / h^2. Many make rounds slow to settle, and few let a solid
/// sink, until the iterations push it out again.
constexpr double kHardness = 100.0;

void add_elements(const ElementFamily& family, std::span<const float4> positions,
                  std::vector<double>& sums) {
    for (int e = 0; e < family.count(); ++e) {
        const auto corners = family.corners(e);
        const auto stiffness = rest_stiffness(family, e, positions);
        for (std::size_t k = 0; k < corners.size(); ++k)
            sums[static_cast<std::size_t>(corners[k])] += stiffness[k];
    }
}

}  // namespace

std::vector<float> contact_stiffness(const Model& model) {
    const auto positions = model.positions->span();
    std::vector<double> sums(positions.size());
    for (std::size_t v = 0; v < sums.size(); ++v) {
        sums[v] = model.masses[v] / (model.h * model.h);
    }
    for (const auto& family : model.families) add_elements(*family, positions, sums);
    std::vector<float> stiffness(sums.size());
    for (std::size_t v = 0; v < sums.size(); ++v) {
        stiffness[v] = static_cast<float>(positions[v].w > 0.0f ? sums[v] : kHeld);
    }
    return stiffness;
}

std::vector<float> hard_stiffness(const Model& model) {
    std::vector<float> stiffness = contact_stiffness(model);
    for (std::size_t v = 0; v < stiffness.size(); ++v) {
        const double inertia = model.masses[v] / (model.h * model.h);
        stiffness[v] += static_cast<float>(kHardness * inertia);
    }
    return stiffness;
}

std::vector<Vec3> rest_of(const Model& model) {
    std::vector<Vec3> rest;
    for (const float4& x : model.positions->span()) rest.push_back(to_vec3(x));
    return rest;
}

SurfaceMesh surface_of(const Model& model, double thickness) {
    SurfaceMesh mesh;
    const auto& rank = model.strips.rank;
    for (const auto& t : model.triangles) {
        auto& triangle = mesh.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = rank[static_cast<std::size_t>(t[k])];
    }
    for (std::size_t body = 0; body < model.bodies.size(); ++body) {
        mesh.triangle_body.insert(mesh.triangle_body.end(),
                                  static_cast<std::size_t>(model.bodies[body].triangle_count),
                                  static_cast<int>(body));
    }
    mesh.rest = rest_of(model);
    for (const float4& x : model.positions->span()) mesh.held.push_back(x.w > 0.0f ? 0 : 1);
    mesh.knots = knots_of(model, thickness);
    return mesh;
}

}  // namespace weft
