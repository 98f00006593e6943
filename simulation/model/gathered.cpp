#include "simulation/model/gathered.h"

#include <fmt/format.h>

#include "simulation/bodies/cloth_mesh.h"
#include "simulation/bodies/obstacle_mesh.h"
#include "simulation/bodies/solid_mesh.h"
#include "simulation/families/builder.h"
#include "simulation/model/origin.h"
#include "simulation/model/shared_pins.h"
#include "simulation/topology/adjacency.h"

namespace weft {

namespace {

/// What cloths and solids have in common. Returns the body's first vertex.
template <class Body, class Mesh>
int add_body(Gathered& all, const std::string& kind, const Body& body, const Mesh& mesh,
             Warnings& warnings) {
    const int first = static_cast<int>(all.rest.size());
    all.bodies.push_back({body.name, kind, first, mesh.vertex_count()});
    all.rest.insert(all.rest.end(), mesh.positions.begin(), mesh.positions.end());
    all.masses.resize(all.rest.size(), 0.0);
    all.held.resize(all.rest.size(), 0);
    all.damping.resize(all.rest.size(), body.damping.value_or(0.0));
    all.is_damped = all.is_damped || body.damping.has_value();
    SharedPins shared(mesh.vertex_count());
    for (const PinGroup& pins : body.pins) {
        MovingPins::Group group;
        for (const int vertex : pinned_vertices(body, pins, mesh)) {
            const auto v = static_cast<std::size_t>(first + vertex);
            all.held[v] = 1;
            shared.add(vertex, pins);
            group.vertices.push_back(first + vertex);
            group.rest.push_back(all.rest[v]);
        }
        if (!pins.motion) continue;
        group.motion = *pins.motion;
        all.moving.push_back(std::move(group));
    }
    shared.warn(fmt::format("{} '{}'", kind, body.name), warnings);
    return first;
}

/// That of the last body.
void add_surface(Gathered& all, const std::vector<std::array<int, 3>>& triangles, int first) {
    all.bodies.back().first_triangle = static_cast<int>(all.triangles.size());
    all.bodies.back().triangle_count = static_cast<int>(triangles.size());
    all.triangles.reserve(all.triangles.size() + triangles.size());
    for (const auto& t : triangles) {
        all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
}

/// The mass of an element, in equal parts to its corners.
template <std::size_t arity>
void add_mass(Gathered& all, const std::array<int, arity>& element, int first, double mass) {
    for (const int vertex : element) {
        all.masses[static_cast<std::size_t>(first + vertex)] += mass / static_cast<double>(arity);
    }
}

void add_cloth(Gathered& all, const Scene& scene, const Cloth& cloth, Warnings& warnings) {
    const TriangleMesh mesh = build_cloth_mesh(cloth, warnings);
    const int first = add_body(all, "cloth", cloth, mesh, warnings);
    all.bearings.push_back({cloth.density, cloth.bend ? cloth.bend->stiffness : 0.0});
    if (std::holds_alternative<MeshFile>(cloth.shape)) {
        all.bodies.back().parts = named_parts(mesh);
        all.bodies.back().welded = mesh.welded;
    }
    add_surface(all, mesh.triangles, first);
    const RestShape rest(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        add_mass(all, mesh.triangles[t], first, cloth.density * rest.area_of(t));
    }

    std::vector<int> corners;
    for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const Adjacency adjacency = find_adjacency(mesh.vertex_count(), corners);
    for (const auto& family : all.families) {
        family->add(ClothPart{scene, cloth, mesh, adjacency, rest, first});
    }
}

void add_solid(Gathered& all, const Solid& solid, Warnings& warnings) {
    const TetMesh mesh = build_solid_mesh(solid, warnings);
    const int first = add_body(all, "solid", solid, mesh, warnings);
    all.bearings.push_back({solid.density, solid.material.young});
    add_surface(all, boundary_faces(mesh), first);
    for (const auto& t : mesh.tetrahedra) {
        add_mass(all, t, first, solid.density * six_volumes(mesh, t) / 6.0);
    }
    for (const auto& family : all.families) family->add(SolidPart{solid, mesh, first});
}

/// A surface that moves as it is told: vertices without mass, all held, and no element.
void add_obstacle(Gathered& all, const MeshObstacle& obstacle, Warnings& warnings) {
    auto [mesh, frames] = build_obstacle_mesh(obstacle, warnings);
    const int first = static_cast<int>(all.rest.size());
    all.bodies.push_back({obstacle.name, "obstacle", first, mesh.vertex_count()});
    all.bearings.push_back({});
    all.rest.insert(all.rest.end(), mesh.positions.begin(), mesh.positions.end());
    all.masses.resize(all.rest.size(), 0.0);
    all.held.resize(all.rest.size(), 1);
    all.damping.resize(all.rest.size(), 0.0);
    add_surface(all, mesh.triangles, first);
    for (const auto& t : mesh.triangles) {
        for (const int v : t) all.obstacle_triangles.vertices.push_back(first + v);
    }
    MovingPins::Group group;
    group.frames = std::move(frames);
    group.frame_time = obstacle.frame_time;
    if (!obstacle.motion && group.frames.empty()) return;
    group.motion = obstacle.motion.value_or(Motion{});
    for (int v = 0; v < mesh.vertex_count(); ++v) group.vertices.push_back(first + v);
    group.rest = mesh.positions;
    all.moving.push_back(std::move(group));
}

}  // namespace

Gathered gather(const Scene& scene, Warnings& warnings) {
    Gathered all;
    all.families = make_family_builders();
    for (const Cloth& cloth : scene.cloths) add_cloth(all, scene, cloth, warnings);
    for (const Solid& solid : scene.solids) add_solid(all, solid, warnings);
    for (const MeshObstacle& obstacle : scene.mesh_obstacles) {
        add_obstacle(all, obstacle, warnings);
    }
    for (const auto& family : all.families) family->add(ScenePart{scene, all.bodies, all.rest});
    count_from(origin_of(all), all);
    std::erase_if(all.families, [](const auto& family) { return family->stencils().count() == 0; });
    return all;
}

}  // namespace weft
