#include "simulation/model/model.h"

#include <algorithm>

#include "simulation/model/convert.h"

namespace weft {

namespace {

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
    Gathered all = gather(scene, warnings);
    bodies = std::move(all.bodies);
    triangles = std::move(all.triangles);
    triangle_body = std::move(all.triangle_body);
    damped = all.is_damped;

    StripOptions options;
    options.extra_levels = is_vertex_wise(scene.solver.method) ? 1 : 0;
    std::vector<Stencils> kinds;
    for (const Stencils* kind : {&all.springs, &all.membranes, &all.hinges, &all.tetrahedra}) {
        if (kind->count() > 0) kinds.push_back(*kind);
    }
    strips = make_strips(static_cast<int>(all.rest.size()), kinds, options);
    strip_begin_ = std::make_unique<Buffer<int>>("strips", strips.begin.size());
    std::copy(strips.begin.begin(), strips.begin.end(), strip_begin_->data());
    vertices_ = {strip_begin_.get(), 0, 1, strips.count()};

    make_vertices(all);
    make_elements(all);
    if (!all.moving.empty()) {
        moving_pins = std::make_unique<MovingPins>(in_new_order(std::move(all.moving), strips),
                                                   strips, scene.substeps);
    }
    if (!scene.obstacles.empty()) {
        obstacles = std::make_unique<Obstacles>(scene.obstacles, scene.substeps);
    }
}

void Model::make_vertices(const Gathered& all) {
    const std::size_t count = all.rest.size();
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
}

void Model::make_elements(const Gathered& all) {
    if (all.springs.count() > 0) {
        springs = std::make_unique<Springs>(all.springs, strips, all.rest, all.spring_stiffness,
                                            all.edge_count);
    }
    if (all.membranes.count() > 0) {
        membranes =
            std::make_unique<Membranes>(all.membranes, strips, all.rest, all.membrane_stiffness);
    }
    if (all.hinges.count() > 0) {
        hinges = std::make_unique<Hinges>(all.hinges, strips, all.rest, all.hinge_stiffness);
    }
    if (all.tetrahedra.count() > 0) {
        tetrahedra = std::make_unique<Tetrahedra>(all.tetrahedra, strips, all.rest,
                                                  all.tetrahedron_stiffness);
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
