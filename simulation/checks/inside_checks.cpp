#include "simulation/checks/inside_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weft {

/// Into which obstacle vertices of one body have come the deepest, and how many into that one.
struct InsideChecks::Inside {
    int obstacle = 0;
    double deepest = 0.0;  ///< [m]
    int count = 0;
    std::vector<int> vertices;  ///< the body's own numbers, the first few
};

InsideChecks::Inside InsideChecks::find_inside(const Model& model, const BodyRange& body,
                                               const Depths& depths) {
    constexpr std::size_t kNamed = 3;
    std::vector<Inside> all(model.convex_obstacles.size());
    for (int own = 0; own < body.vertex_count; ++own) {
        const auto v = static_cast<std::size_t>(model.vertex(body.vertex(own)));
        const auto [obstacle, depth] = depths(v);
        if (depth <= 0.0) continue;
        Inside& one = all[static_cast<std::size_t>(obstacle)];
        one.obstacle = obstacle;
        one.deepest = std::max(one.deepest, depth);
        ++one.count;
        if (one.vertices.size() < kNamed) one.vertices.push_back(own);
    }
    return *std::ranges::max_element(all, {}, &Inside::deepest);
}

/// deepest_ is what the frame has to tell, if that is plainly deeper than what was told.
std::optional<Alarm> InsideChecks::look(const Model& model, const Depths& depths, const char* what,
                                        const std::string& remedy) {
    std::optional<Alarm> alarm;
    deepest_ = 1.5 * told_;
    for (const BodyRange& body : model.bodies) {
        const Inside inside = find_inside(model, body, depths);
        if (inside.deepest <= deepest_) continue;
        deepest_ = inside.deepest;
        const std::string told = fmt::format(
            "obstacle '{}' has come up to {:.3g} m into, or through, {}{} of {} vertices of {} "
            "'{}' (the first: {})",
            model.convex_obstacles[static_cast<std::size_t>(inside.obstacle)].name, inside.deepest,
            what, inside.count, body.vertex_count, body.kind, body.name,
            fmt::join(inside.vertices, ", "));
        alarm = {Alarm::Kind::kDoubt, told, {}, remedy};
    }
    return alarm;
}

std::optional<Alarm> InsideChecks::look(const Model& model, ContactResponse& contact) {
    // Half of what contact keeps between two surfaces is what is plainly within one of them.
    const double floor = 0.5 * model.scene.contact->thickness;
    Insides& insides = *contact.insides();
    const auto depth_of = [&](std::size_t vertex) {
        const auto depth = static_cast<double>(insides.depths()[vertex]);
        return Depth{insides.obstacles()[vertex], depth > floor ? depth : 0.0};
    };
    return look(model, depth_of, "",
                fmt::format("contact lets them go no farther in a substep: some {} substeps would "
                            "do (docs/contact.md)",
                            contact.account().substeps_wanted()));
}

/// Where more than half of what the obstacle is wide is in a triangle, the other side is near.
InsideChecks::Depth InsideChecks::depth_of_triangles(const Model& model, NarrowObstacles& narrow,
                                                     std::size_t vertex) {
    Depth deepest;
    for (std::size_t o = 0; o < model.convex_obstacles.size(); ++o) {
        const int column = narrow.number_of(static_cast<int>(o));
        if (column < 0) continue;
        const Obstacle& obstacle = model.convex_obstacles[o];
        const auto row = static_cast<std::size_t>(column * narrow.vertex_count()) + vertex;
        const auto depth = static_cast<double>(narrow.depths()[row]);
        const bool is_within = depth > obstacle.thickness + 0.5 * obstacle.half_width;
        if (is_within && depth > deepest.depth) deepest = {static_cast<int>(o), depth};
    }
    return deepest;
}

std::optional<Alarm> InsideChecks::look(const Model& model, NarrowObstacles& narrow) {
    const auto depth_of = [&](std::size_t vertex) {
        return depth_of_triangles(model, narrow, vertex);
    };
    return look(model, depth_of, "triangles around ", {});
}

}  // namespace weft
