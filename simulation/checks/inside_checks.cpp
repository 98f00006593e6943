#include "simulation/checks/inside_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weft {

namespace {

/// Into which obstacle vertices of one body have come the deepest, and how many into that one.
struct Inside {
    int obstacle = 0;
    double deepest = 0.0;  ///< [m]
    int count = 0;
    std::vector<int> vertices;  ///< the body's own numbers, the first few
};

/// floor  [m] what is less deep does not count
Inside find_inside(const Model& model, const BodyRange& body, Insides& insides, double floor) {
    constexpr std::size_t kNamed = 3;
    std::vector<Inside> all(model.convex_obstacles.size());
    for (int own = 0; own < body.vertex_count; ++own) {
        const auto v = static_cast<std::size_t>(model.vertex(body.vertex(own)));
        const auto depth = static_cast<double>(insides.depths()[v]);
        if (depth <= floor) continue;
        Inside& one = all[static_cast<std::size_t>(insides.obstacles()[v])];
        one.obstacle = insides.obstacles()[v];
        one.deepest = std::max(one.deepest, depth);
        ++one.count;
        if (one.vertices.size() < kNamed) one.vertices.push_back(own);
    }
    return *std::ranges::max_element(all, {}, &Inside::deepest);
}

std::string tell(const Model& model, const BodyRange& body, const Inside& inside) {
    return fmt::format(
        "obstacle '{}' has come up to {:.3g} m into, or through, {} of {} vertices of {} '{}' (the "
        "first: {})",
        model.convex_obstacles[static_cast<std::size_t>(inside.obstacle)].name, inside.deepest,
        inside.count, body.vertex_count, body.kind, body.name, fmt::join(inside.vertices, ", "));
}

}  // namespace

std::optional<Alarm> InsideChecks::look(const Model& model, ContactResponse& contact) {
    // Half of what contact keeps between two surfaces is what is plainly within one of them.
    const double floor = 0.5 * model.scene.contact->thickness;
    std::optional<Alarm> alarm;
    deepest_ = 1.5 * told_;
    for (const BodyRange& body : model.bodies) {
        const Inside inside = find_inside(model, body, *contact.insides(), floor);
        if (inside.deepest <= deepest_) continue;
        deepest_ = inside.deepest;
        alarm = {
            Alarm::Kind::kDoubt,
            tell(model, body, inside),
            {},
            fmt::format("contact lets them go no farther in a substep: some {} substeps would do "
                        "(docs/contact.md)",
                        contact.substeps_wanted())};
    }
    return alarm;
}

}  // namespace weft
