#include "simulation/model/model.h"

#include <algorithm>

#include "runtime/error.h"
#include "simulation/model/convert.h"
#include "simulation/scene/cloth_mesh.h"
#include "simulation/topology/adjacency.h"

namespace weft {

namespace {

/// Everything about the scene's cloths in scene order, gathered before strips are known.
struct Gathered {
    std::vector<Vec3> rest;
    std::vector<double> masses;
    std::vector<char> held;
    std::vector<double> damping;
    Stencils edges{2, {}};
    std::vector<double> edge_stiffness;
    Stencils hinges{4, {}};
    std::vector<double> hinge_stiffness;
    std::vector<MovingPins::Group> moving;  ///< vertices in scene order
};

void append(Stencils& all, const Stencils& some, int first_vertex) {
    for (const int vertex : some.vertices) all.vertices.push_back(vertex + first_vertex);
}

/// A third of each triangle's mass to each of its corners.
void add_masses(Gathered& all, const TriangleMesh& mesh, double density, std::size_t first) {
    for (const auto& t : mesh.triangles) {
        const auto corner = [&](int k) {
            return mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
        };
        const double area = 0.5 * length(cross(corner(1) - corner(0), corner(2) - corner(0)));
        for (const int vertex : t)
            all.masses[first + static_cast<std::size_t>(vertex)] += density * area / 3.0;
    }
}

void add_elements(Gathered& all, const Cloth& cloth, const TriangleMesh& mesh, int first) {
    std::vector<int> corners;
    for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const Adjacency adjacency = find_adjacency(mesh.vertex_count(), corners);
    append(all.edges, adjacency.edges, first);
    all.edge_stiffness.resize(static_cast<std::size_t>(all.edges.count()), cloth.stretch.stiffness);
    if (!cloth.bend) return;
    append(all.hinges, adjacency.hinges, first);
    all.hinge_stiffness.resize(static_cast<std::size_t>(all.hinges.count()), cloth.bend->stiffness);
}

void add_pins(Gathered& all, const Cloth& cloth, const TriangleMesh& mesh, int first) {
    for (const PinGroup& pins : cloth.pins) {
        MovingPins::Group group;
        for (const int vertex : pinned_vertices(cloth, pins, mesh)) {
            const auto v = static_cast<std::size_t>(first + vertex);
            all.held[v] = 1;
            group.vertices.push_back(first + vertex);
            group.rest.push_back(all.rest[v]);
        }
        if (!pins.motion) continue;
        group.motion = *pins.motion;
        all.moving.push_back(std::move(group));
    }
}

/// Pins in the new order of vertices, ascending.
std::vector<MovingPins::Group> in_new_order(std::vector<MovingPins::Group> groups,
                                            const Strips& strips) {
    for (MovingPins::Group& group : groups) {
        std::vector<std::pair<int, Vec3>> pins;
        for (std::size_t i = 0; i < group.vertices.size(); ++i) {
            pins.emplace_back(strips.rank[static_cast<std::size_t>(group.vertices[i])],
                              group.rest[i]);
        }
        std::sort(pins.begin(), pins.end(),
                  [](const auto& a, const auto& b) { return a.first < b.first; });
        for (std::size_t i = 0; i < pins.size(); ++i) {
            std::tie(group.vertices[i], group.rest[i]) = pins[i];
        }
    }
    return groups;
}

}  // namespace

Model::Model(const Scene& given, Warnings& warnings) : scene(given), h(given.dt / given.substeps) {
    Gathered all;
    for (const Cloth& cloth : scene.cloths) {
        const TriangleMesh mesh = build_cloth_mesh(cloth, warnings);
        const std::size_t first = all.rest.size();
        const int first_vertex = static_cast<int>(first);
        for (const auto& t : mesh.triangles) {
            triangles.push_back({t[0] + first_vertex, t[1] + first_vertex, t[2] + first_vertex});
            triangle_body.push_back(static_cast<int>(bodies.size()));
        }
        bodies.push_back({cloth.name, first_vertex, mesh.vertex_count()});
        all.rest.insert(all.rest.end(), mesh.positions.begin(), mesh.positions.end());
        all.masses.resize(all.rest.size(), 0.0);
        all.held.resize(all.rest.size(), 0);
        all.damping.resize(all.rest.size(), cloth.damping.value_or(0.0));
        damped = damped || cloth.damping.has_value();
        add_masses(all, mesh, cloth.density, first);
        add_elements(all, cloth, mesh, first_vertex);
        add_pins(all, cloth, mesh, first_vertex);
    }
    const std::size_t count = all.rest.size();
    const bool bends = all.hinges.count() > 0;

    std::vector<Stencils> kinds{all.edges};
    if (bends) kinds.push_back(all.hinges);
    StripOptions options;
    options.extra_levels = is_vertex_wise(scene.solver.method) ? 1 : 0;
    strips = make_strips(static_cast<int>(count), kinds, options);
    strip_begin_ = std::make_unique<Buffer<int>>("strips", strips.begin.size());
    std::copy(strips.begin.begin(), strips.begin.end(), strip_begin_->data());
    vertices_ = {strip_begin_.get(), 0, 1, strips.count()};

    positions = std::make_unique<Buffer<float4>>("positions", count);
    previous = std::make_unique<Buffer<float4>>("previous", count);
    velocities = std::make_unique<Buffer<float4>>("velocities", count);
    gravity = std::make_unique<Buffer<float4>>("gravity", static_cast<std::size_t>(scene.substeps));
    masses.resize(count);
    for (std::size_t v = 0; v < count; ++v) {
        const auto old = static_cast<std::size_t>(strips.order[v]);
        const bool free = all.held[old] == 0 && all.masses[old] > 0.0;
        masses[v] = all.masses[old];
        (*positions)[v] = to_float4(all.rest[old], free ? 1.0 / all.masses[old] : 0.0);
        (*velocities)[v] = to_float4({}, 1.0 / (1.0 + h * all.damping[old]));
    }

    springs = std::make_unique<Springs>(all.edges, strips, all.rest, all.edge_stiffness);
    if (bends) hinges = std::make_unique<Hinges>(all.hinges, strips, all.rest, all.hinge_stiffness);
    if (!all.moving.empty()) {
        moving_pins = std::make_unique<MovingPins>(in_new_order(std::move(all.moving), strips),
                                                   strips, scene.substeps);
    }
    if (!scene.obstacles.empty()) {
        obstacles = std::make_unique<Obstacles>(scene.obstacles, scene.substeps);
    }
}

void Model::place(double time) {
    for (int substep = 0; substep < scene.substeps; ++substep) {
        (*gravity)[static_cast<std::size_t>(substep)] =
            to_float4(scene.gravity_at(time + (substep + 0.5) * h));
    }
    if (moving_pins) moving_pins->place(time, h);
    if (obstacles) obstacles->place(time, h);
}

std::vector<BufferStorage*> Model::placed_buffers() {
    std::vector<BufferStorage*> buffers{gravity.get()};
    if (moving_pins) buffers.push_back(&moving_pins->motions());
    if (obstacles) buffers.push_back(&obstacles->placements());
    return buffers;
}

}  // namespace weft
