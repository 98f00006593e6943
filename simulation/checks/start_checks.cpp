#include "simulation/checks/start_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "simulation/checks/energy_account.h"
#include "simulation/families/convert.h"
#include "simulation/families/hinges/hinge_shape.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/model/reach.h"

namespace weft {

namespace {

/// The vertices of one body that start inside one obstacle.
struct Inside {
    std::vector<int> vertices;  ///< the body's own numbers, the first few
    int count = 0;
    bool by_triangles = false;  ///< some of them by triangles around them alone
    double deepest = 0.0;       ///< [m]
    double energy = 0.0;        ///< [J] that they get if they are pushed out in one substep
};

Inside find_inside(const Model& model, const BodyRange& body, std::size_t number) {
    constexpr std::size_t kNamed = 3;
    const Obstacle& obstacle = model.convex_obstacles[number];
    const Frame frame = obstacle.frame_at(0.0);
    Inside inside;
    for (int own = 0; own < body.vertex_count; ++own) {
        const int v = model.vertex(body.vertex(own));
        const float4& x = (*model.positions)[static_cast<std::size_t>(v)];
        if (x.w == 0.0f) continue;  // obstacles do not push what is held
        const double own_depth = -distance_to(obstacle, to_vec3(x), 0.0);
        const double depth = std::max(own_depth, model.obstacles->depth_of_triangles(
                                                     number, frame, v, model.positions->span()));
        if (depth <= 0.0) continue;
        inside.by_triangles |= own_depth <= 0.0;
        if (inside.vertices.size() < kNamed) inside.vertices.push_back(own);
        ++inside.count;
        inside.deepest = std::max(inside.deepest, depth);
        const double speed = depth / model.h;
        inside.energy += 0.5 * model.masses[static_cast<std::size_t>(v)] * speed * speed;
    }
    return inside;
}

void warn_of_inside(const Model& model, std::size_t number, Warnings& warnings) {
    const Obstacle& obstacle = model.convex_obstacles[number];
    for (const BodyRange& body : model.bodies) {
        const Inside inside = find_inside(model, body, number);
        if (inside.count == 0) continue;
        warnings.push_back(fmt::format(
            "{} of {} vertices of {} '{}'{} start inside obstacle '{}' (the first: {}), up to "
            "{:.3g} m deep; the first substep pushes them out, at up to {:.3g} m/s and with {:.3g} "
            "J: move one of the two",
            inside.count, body.vertex_count, body.kind, body.name,
            inside.by_triangles ? ", or triangles around them," : "", obstacle.name,
            fmt::join(inside.vertices, ", "), inside.deepest, inside.deepest / model.h,
            inside.energy));
    }
}

/// A sweep takes the way of a vertex as straight in the obstacle's frame. Within this angle the way
/// of a resting vertex bulges out of it by less than a tenth of its distance from the axis.
constexpr double kLargestTurn = 45.0;  // [degrees]

void warn_of_turns(const Model& model, const Obstacle& obstacle, Warnings& warnings) {
    if (!obstacle.motion || !std::isfinite(obstacle.half_width)) return;
    const FastestTurn turn = fastest_turn(*obstacle.motion);
    if (turn.rate * model.h <= kLargestTurn) return;
    const Scene& scene = model.scene;
    warnings.push_back(fmt::format(
        "obstacle '{}' turns by {:.3g} degrees in one substep of frame {}: cloth in its way may be "
        "passed or pushed too far; it takes {} substeps",
        obstacle.name, turn.rate * model.h, static_cast<int>(turn.time / scene.dt),
        static_cast<long>(std::ceil(turn.rate * scene.dt / kLargestTurn - 1e-6))));
}

/// The largest coordinate of anything with mass, as the model counts them [m].
double reach_of_bodies(const Model& model) {
    double most = 0.0;
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        if (!(model.masses[v] > 0.0)) continue;
        const Vec3 x = to_vec3((*model.positions)[v]);
        most = std::max({most, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
    return most;
}

/// The way that gravity makes in a substep [m]; 0: there is none.
double fall_in_substep(const Model& model) {
    return length(model.scene.gravity_at(0.0)) * model.h * model.h;
}

/// Whether that much rounding shows. Shapes: rounded to 0.7 % of its edges, a sheet had 0.5 to 0.8
/// of its motion. Motion, as rounding takes or gives a part of what gravity does in a substep: with
/// 40 % of that, and 0.05 % of its edges, a block sank by 2 to 17 % too far (docs/measurements.md).
/// Edges have a say there, too: triangles as thin as that keep still.
bool shows(double rounding, double shortest, const Model& model) {
    constexpr double kOfShapes = 0.0025, kOfEdges = 0.0002, kOfFall = 0.2;
    if (rounding >= kOfShapes * shortest) return true;
    const double fall = fall_in_substep(model);
    return fall > 0.0 && rounding >= kOfFall * fall && rounding >= kOfEdges * shortest;
}

/// What keeps motion where steps have to be so many times as long; the length of a frame is the
/// most that fewer substeps give.
std::string longer_steps(const Scene& scene, double longer) {
    const double fewer = scene.substeps / longer;
    if (fewer >= 1.0) {
        return fmt::format("scene.substeps = {} (instead of {}) with more iterations keeps it",
                           static_cast<int>(fewer), scene.substeps);
    }
    return fmt::format(
        "scene.dt = {:.2g} s is too short for single precision: frames of {:.1g} s or more, of one "
        "substep each, keep it",
        scene.dt, scene.dt / fewer);
}

/// Velocities are differences of positions: in steps in which gravity moves by less than rounding
/// does, motion gets lost, or comes from nowhere. A sheet of 1 m (scenes/sheet.toml, 2 iterations)
/// came nearest to its reference with 128 substeps, in which rounding is a fifth of that way; it
/// was 3 times as far away by 256, and 20 times by 512, by vbd, sosd and newton
/// (docs/measurements.md).
void warn_of_short_steps(const Model& model, double reach, Warnings& warnings) {
    constexpr double kLongEnough = 0.5;
    const double rounding = rounding_at(reach);
    const double fall = fall_in_substep(model);
    if (fall <= 0.0 || rounding < kTooShortBy * fall) return;
    const Scene& scene = model.scene;
    const double longer = std::sqrt(rounding / (kLongEnough * fall));
    warnings.push_back(fmt::format(
        "steps of {:.2g} s are so short that the rounding of coordinates of {:.3g} m ({:.1g} m) is "
        "{:.2g} times the way that gravity makes in one: motion gets lost, or comes from nowhere; "
        "{}",
        model.h, reach, rounding, rounding / fall, longer_steps(scene, longer)));
}

/// Positions are single precision, counted from a place near the bodies: in a scene that is large,
/// what is fine is hardly there.
void warn_of_rounding(const Model& model, Warnings& warnings) {
    const double reach = reach_of_bodies(model);
    const double rounding = rounding_at(reach);
    const double shortest = model.edges->shortest();
    if (shortest <= 0.0) return;
    if (!shows(rounding, shortest, model)) return warn_of_short_steps(model, reach, warnings);
    warnings.push_back(fmt::format(
        "coordinates of {:.3g} m, from a place near the bodies, are rounded to {:.1g} m, {:.2g} % "
        "of the shortest edge ({:.3g} m): shapes that fine and slow motion are not kept; bring "
        "bodies that are far apart nearer to each other, or leave such edges out",
        reach, rounding, 100.0 * rounding / shortest, shortest));
}

/// Of a hinge that is folded shut, the bending of hinge.h pulls along the triangles, to neither
/// side: an equilibrium, though an unstable one. From 179.9 degrees on, folds open.
bool is_shut(const Model& model, const Hinges& hinges, int hinge) {
    constexpr double kShut = 1e-4;  // cosine of half the fold: 180 degrees, less a hundredth
    const auto vertices = hinges.corners(hinge);
    HingeCorners x;
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = to_vec3((*model.positions)[static_cast<std::size_t>(vertices[k])]);
    }
    return half_fold(x).cosine < kShut;
}

std::size_t body_of_vertex(const Model& model, int v) {
    const int in_scene = model.strips.order[static_cast<std::size_t>(v)];
    const auto behind =
        std::ranges::upper_bound(model.bodies, in_scene, {}, &BodyRange::first_vertex);
    return static_cast<std::size_t>(behind - model.bodies.begin()) - 1;
}

void warn_of_shut_folds(const Model& model, Warnings& warnings) {
    const Hinges* hinges = model.find<Hinges>();
    const auto may_be_folded = [](const Cloth& cloth) {
        const auto* file = std::get_if<MeshFile>(&cloth.shape);
        const bool has_rest = file != nullptr && !file->rest.empty();
        return cloth.bend && (cloth.bend->rest_is_flat || has_rest);
    };
    if (hinges == nullptr || std::ranges::none_of(model.scene.cloths, may_be_folded)) return;
    std::vector<int> shut(model.bodies.size());
    for (int h = 0; h < hinges->count(); ++h) {
        if (is_shut(model, *hinges, h)) ++shut[body_of_vertex(model, hinges->corners(h)[0])];
    }
    for (std::size_t b = 0; b < shut.size(); ++b) {
        if (shut[b] == 0) continue;
        warnings.push_back(fmt::format(
            "'{}' starts folded by 180 degrees over {} of its edges that are flat at rest: bending "
            "opens such a fold to neither side; start it a tenth of a degree less folded",
            model.bodies[b].name, shut[b]));
    }
}

}  // namespace

double energy_inside_obstacles(const Model& model) {
    double energy = 0.0;
    for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
        for (const BodyRange& body : model.bodies) energy += find_inside(model, body, o).energy;
    }
    return energy;
}

void warn_of_start(const Model& model, Warnings& warnings) {
    warn_of_rounding(model, warnings);
    warn_of_shut_folds(model, warnings);
    for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
        warn_of_inside(model, o, warnings);
        warn_of_turns(model, model.convex_obstacles[o], warnings);
    }
}

}  // namespace weft
