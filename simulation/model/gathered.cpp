#include "simulation/model/gathered.h"

#include "simulation/model/attachments.h"
#include "simulation/scene/cloth_mesh.h"
#include "simulation/scene/solid_mesh.h"
#include "simulation/topology/adjacency.h"

namespace weft {

namespace {

template <std::size_t arity>
void append(Stencils& all, const std::vector<std::array<int, arity>>& some, int first_vertex) {
    for (const auto& element : some) {
        for (const int vertex : element) all.vertices.push_back(vertex + first_vertex);
    }
}

void append(Stencils& all, const Stencils& some, int first_vertex) {
    for (const int vertex : some.vertices) all.vertices.push_back(vertex + first_vertex);
}

/// Gives every element without one this value: those of the body that was just appended.
template <class Value>
void fill(std::vector<Value>& values, const Stencils& elements, const Value& value) {
    values.resize(static_cast<std::size_t>(elements.count()), value);
}

/// What cloths and solids have in common. Returns the body's first vertex.
template <class Body, class Mesh>
int add_body(Gathered& all, const std::string& kind, const Body& body, const Mesh& mesh) {
    const int first = static_cast<int>(all.rest.size());
    all.bodies.push_back({body.name, kind, first, mesh.vertex_count()});
    all.rest.insert(all.rest.end(), mesh.positions.begin(), mesh.positions.end());
    all.masses.resize(all.rest.size(), 0.0);
    all.held.resize(all.rest.size(), 0);
    all.damping.resize(all.rest.size(), body.damping.value_or(0.0));
    all.is_damped = all.is_damped || body.damping.has_value();
    for (const PinGroup& pins : body.pins) {
        MovingPins::Group group;
        for (const int vertex : pinned_vertices(body, pins, mesh)) {
            const auto v = static_cast<std::size_t>(first + vertex);
            all.held[v] = 1;
            group.vertices.push_back(first + vertex);
            group.rest.push_back(all.rest[v]);
        }
        if (!pins.motion) continue;
        group.motion = *pins.motion;
        all.moving.push_back(std::move(group));
    }
    return first;
}

void add_surface(Gathered& all, const std::vector<std::array<int, 3>>& triangles, int first) {
    for (const auto& t : triangles) {
        all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        all.triangle_body.push_back(static_cast<int>(all.bodies.size()) - 1);
    }
}

/// The mass of an element, in equal parts to its corners.
template <std::size_t arity>
void add_mass(Gathered& all, const std::array<int, arity>& element, int first, double mass) {
    for (const int vertex : element) {
        all.masses[static_cast<std::size_t>(first + vertex)] += mass / static_cast<double>(arity);
    }
}

double area(const TriangleMesh& mesh, const std::array<int, 3>& t) {
    const auto corner = [&](std::size_t k) {
        return mesh.positions[static_cast<std::size_t>(t[k])];
    };
    return 0.5 * length(cross(corner(1) - corner(0), corner(2) - corner(0)));
}

void add_cloth(Gathered& all, const Cloth& cloth, Warnings& warnings) {
    const TriangleMesh mesh = build_cloth_mesh(cloth, warnings);
    const int first = add_body(all, "cloth", cloth, mesh);
    add_surface(all, mesh.triangles, first);
    for (const auto& t : mesh.triangles) add_mass(all, t, first, cloth.density * area(mesh, t));

    std::vector<int> corners;
    for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
    const Adjacency adjacency = find_adjacency(mesh.vertex_count(), corners);
    if (cloth.stretch.stiffness > 0.0) {
        append(all.springs, adjacency.edges, first);
        fill(all.spring_stiffness, all.springs, cloth.stretch.stiffness);
    }
    if (cloth.membrane) {
        append(all.membranes, mesh.triangles, first);
        fill(all.membrane_stiffness, all.membranes, stiffness_of(*cloth.membrane));
    }
    if (cloth.bend) {
        append(all.hinges, adjacency.hinges, first);
        fill(all.hinge_stiffness, all.hinges, cloth.bend->stiffness);
    }
}

void add_solid(Gathered& all, const Solid& solid, Warnings& warnings) {
    const TetMesh mesh = build_solid_mesh(solid, warnings);
    const int first = add_body(all, "solid", solid, mesh);
    add_surface(all, boundary_faces(mesh), first);
    for (const auto& t : mesh.tetrahedra) {
        add_mass(all, t, first, solid.density * six_volumes(mesh, t) / 6.0);
    }
    append(all.tetrahedra, mesh.tetrahedra, first);
    fill(all.tetrahedron_stiffness, all.tetrahedra, stiffness_of(solid.material));
}

}  // namespace

Gathered gather(const Scene& scene, Warnings& warnings) {
    Gathered all;
    for (const Cloth& cloth : scene.cloths) add_cloth(all, cloth, warnings);
    for (const Solid& solid : scene.solids) add_solid(all, solid, warnings);
    all.edge_count = all.springs.count();
    for (const Attachment& attachment : scene.attachments) {
        const auto ties = find_ties(attachment, scene, all.bodies, all.rest);
        append(all.springs, ties, 0);
        fill(all.spring_stiffness, all.springs, attachment.stiffness);
    }
    return all;
}

}  // namespace weft
