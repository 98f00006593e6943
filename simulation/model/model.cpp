#include "simulation/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"
#include "simulation/model/contact_thickness.h"
#include "simulation/model/origin.h"
#include "simulation/model/substeps.h"

namespace weft {

namespace {

/// Pins in the new order of vertices, ascending.
std::vector<MovingPins::Group> in_new_order(std::vector<MovingPins::Group> groups,
                                            const Strips& strips) {
    for (MovingPins::Group& group : groups) {
        const auto rank = [&](int i) {
            const int old = group.vertices[static_cast<std::size_t>(i)];
            return strips.rank[static_cast<std::size_t>(old)];
        };
        std::vector<int> order(group.vertices.size());
        std::iota(order.begin(), order.end(), 0);
        std::ranges::sort(order, {}, rank);
        const auto sorted = [&](const auto& list) {
            auto copy = list;
            for (std::size_t i = 0; i < order.size(); ++i) {
                copy[i] = list[static_cast<std::size_t>(order[i])];
            }
            return copy;
        };
        group.rest = sorted(group.rest);
        for (auto& frame : group.frames) frame = sorted(frame);
        std::ranges::transform(order, order.begin(), rank);
        group.vertices = std::move(order);
    }
    return groups;
}

/// Whose vertices the strips go by.
std::vector<Stencils> kinds_of(const Gathered& all) {
    std::vector<Stencils> kinds;
    for (const auto& family : all.families) kinds.push_back(family->stencils());
    if (all.obstacle_triangles.count() > 0) kinds.push_back(all.obstacle_triangles);
    return kinds;
}

/// The scene with all values that the file leaves out and the meshes say. warnings: null: it has
/// substeps, and nobody listens
Scene with_values(const Scene& given, const Gathered& all, Warnings* warnings) {
    Scene scene = warnings != nullptr ? with_substeps(given, all, *warnings) : given;
    if (scene.contact) choose_thickness(*scene.contact, all, warnings);
    return scene;
}

Gathered gather_quietly(const Scene& scene) {
    Warnings unheard;
    return gather(scene, unheard);
}

std::vector<Obstacle> counted_from(Vec3 origin, std::vector<Obstacle> obstacles) {
    for (Obstacle& obstacle : obstacles) obstacle = counted_from(origin, std::move(obstacle));
    return obstacles;
}

std::vector<float> moved_by(Vec3 way, std::vector<float> xyz) {
    if (way == Vec3{}) return xyz;  // -0 stays -0
    const double by[3] = {way.x, way.y, way.z};
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        xyz[i] = static_cast<float>(static_cast<double>(xyz[i]) + by[i % 3]);
    }
    return xyz;
}

}  // namespace

Model::Model(const Scene& given, Warnings& warnings)
    : Model(given, gather(given, warnings), &warnings) {}

Model::Model(const Scene& given) : Model(given, gather_quietly(given), nullptr) {}

Model::Model(const Scene& given, Gathered all, Warnings* warnings)
    : scene(with_values(given, all, warnings)),
      h(scene.dt / scene.substeps),
      origin(all.origin),
      convex_obstacles(counted_from(origin, scene.obstacles)) {
    bodies = std::move(all.bodies);
    triangles = std::move(all.triangles);
    damped = all.is_damped;

    StripOptions options;
    options.extra_levels = is_vertex_wise(scene.solver.method) ? 1 : 0;
    strips = make_strips(static_cast<int>(all.rest.size()), kinds_of(all), options);
    strip_begin_ = std::make_unique<Buffer<int>>("strips", strips.begin.size());
    std::copy(strips.begin.begin(), strips.begin.end(), strip_begin_->data());
    vertices_ = {strip_begin_.get(), 0, 1, strips.count()};

    make_vertices(all);
    families.resize(all.families.size());
    for_each_apart(static_cast<int>(families.size()), [&](int f) {
        auto& builder = all.families[static_cast<std::size_t>(f)];
        auto& family = families[static_cast<std::size_t>(f)];
        family = builder->build(strips, all.rest);
        family->reserve(scene.substeps);
        family->elements().forget_originals();
        builder.reset();  // of large scenes, they have much memory
    });
    if (warnings != nullptr) edges = std::make_unique<Edges>(families);
    if (!all.moving.empty()) {
        moving_pins = std::make_unique<MovingPins>(in_new_order(std::move(all.moving), strips),
                                                   strips, scene.substeps);
    }
    if (!convex_obstacles.empty()) {
        obstacles =
            std::make_unique<Obstacles>(convex_obstacles, scene.substeps,
                                        NarrowObstacles::of(convex_obstacles, moving_surface()));
    }
}

MovingSurface Model::moving_surface() const {
    MovingSurface surface{positions->span(), triangles};
    for (auto& triangle : surface.triangles) {
        for (int& v : triangle) v = vertex(SceneVertex{v});
    }
    return surface;
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

std::vector<Stencils> Model::stencils() const {
    std::vector<Stencils> kinds;
    for (const auto& family : families) kinds.push_back(family->elements().stencils());
    return kinds;
}

std::vector<float> Model::in_scene(std::vector<float> xyz) const {
    return moved_by(origin, std::move(xyz));
}

std::vector<float> Model::from_origin(std::vector<float> xyz) const {
    return moved_by(-origin, std::move(xyz));
}

std::size_t Model::body_of_triangle(int triangle) const {
    const auto behind = std::ranges::upper_bound(bodies, triangle, {}, &BodyRange::first_triangle);
    return static_cast<std::size_t>(behind - bodies.begin()) - 1;
}

void Model::place(double time) {
    for (int substep = 0; substep < scene.substeps; ++substep) {
        (*gravity)[static_cast<std::size_t>(substep)] =
            to_float4(scene.gravity_at(time + (substep + 0.5) * h));
    }
    if (moving_pins) moving_pins->place(time, h);
    for (auto& family : families) family->place(time, h);
    if (obstacles) obstacles->place(time, h);
}

std::vector<BufferStorage*> Model::placed_buffers() {
    std::vector<BufferStorage*> buffers{gravity.get()};
    if (moving_pins) moving_pins->add_placed(buffers);
    if (obstacles) buffers.push_back(&obstacles->placements());
    for (auto& family : families) {
        if (BufferStorage* buffer = family->placed_buffer()) buffers.push_back(buffer);
    }
    return buffers;
}

}  // namespace weft
