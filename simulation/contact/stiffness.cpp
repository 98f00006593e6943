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

/// How much of elements' stiffness counts between solids, and between sheets, which press each
/// other across it. All of it is up to 10,000 times m / h^2 and more, which no few iterations
/// solve: piles of sheets stored many times the energy of their fall and swelled, and towers of
/// blocks trembled. But what is taut presses by it: with a sixteenth, sheets on a needle find no
/// place (docs/measurements.md, "How stiff contacts of sheets are" and "of solids").
constexpr double kOfElements = 0.125;

/// And of all that touches cloth, no more than so many m / h^2 (docs/measurements.md, "Solids on
/// stiff sheets").
constexpr double kOfCloth = 1000.0;

/// [vertices] how hard elements hold each [N/m].
std::vector<double> held_by_elements(const Model& model) {
    const auto positions = model.positions->span();
    std::vector<double> sums(positions.size());
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const auto corners = family->corners(e);
            const auto stiffness = rest_stiffness(*family, e, positions);
            for (std::size_t k = 0; k < corners.size(); ++k)
                sums[static_cast<std::size_t>(corners[k])] += stiffness[k];
        }
    }
    return sums;
}

/// m / h^2 and what elements hold the vertex with [N/m].
float with_inertia(const Model& model, std::size_t vertex, double elements) {
    const double sum = model.masses[vertex] / (model.h * model.h) + elements;
    return static_cast<float>((*model.positions)[vertex].w > 0.0f ? sum : kHeld);
}

/// held: as held_by_elements() says
ContactStiffness contact_stiffness(const Model& model, const std::vector<double>& held) {
    ContactStiffness stiffness{std::vector<float>(held.size()),
                               std::vector<float>(held.size(), kNoSheet)};
    for (std::size_t v = 0; v < held.size(); ++v)
        stiffness.of_all[v] = with_inertia(model, v, kOfElements * held[v]);
    for (const BodyRange& body : model.bodies) {
        if (body.kind != "cloth") continue;
        for (int i = 0; i < body.vertex_count; ++i) {
            const auto v = static_cast<std::size_t>(model.vertex(body.vertex(i)));
            const double most = kOfCloth * model.masses[v] / (model.h * model.h);
            stiffness.of_all[v] = with_inertia(model, v, std::min(held[v], most));
            stiffness.between_sheets[v] =
                with_inertia(model, v, std::min(kOfElements * held[v], most));
        }
    }
    return stiffness;
}

}  // namespace

ContactStiffness contact_stiffness(const Model& model) {
    return contact_stiffness(model, held_by_elements(model));
}

std::vector<float> hard_stiffness(const Model& model) {
    const std::vector<double> held = held_by_elements(model);
    std::vector<float> stiffness = contact_stiffness(model, held).between_sheets;
    for (std::size_t v = 0; v < stiffness.size(); ++v) {
        const double inertia = model.masses[v] / (model.h * model.h);
        if (stiffness[v] == kNoSheet) stiffness[v] = with_inertia(model, v, held[v]);
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
