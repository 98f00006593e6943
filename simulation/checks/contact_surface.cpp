#include "simulation/checks/contact_surface.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "simulation/contact/knots.h"

namespace weft {

ContactSurface::ContactSurface(const Model& model)
    : touches_itself_(model.scene.contact->self),
      triangles_(model.triangles),
      positions_(model.positions->count()),
      held_(positions_.size()),
      knots_(positions_.size()),
      tied_(positions_.size()) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        bodies_.push_back(static_cast<int>(model.body_of_triangle(static_cast<int>(t))));
    }
    const std::vector<int> knots = knots_of(model, model.scene.contact->thickness);
    std::vector<int> of_knot(positions_.size());
    for (const int knot : knots) ++of_knot[static_cast<std::size_t>(knot)];
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        const std::size_t s = index(model.scene_vertex(static_cast<int>(v)));
        held_[s] = (*model.positions)[v].w == 0.0f ? 1 : 0;
        knots_[s] = knots[v];
        tied_[s] = of_knot[static_cast<std::size_t>(knots[v])] > 1 ? 1 : 0;
    }
    move(model);
}

void ContactSurface::move(const Model& model) {
    for (std::size_t v = 0; v < positions_.size(); ++v) {
        const float4& x = (*model.positions)[v];
        positions_[index(model.scene_vertex(static_cast<int>(v)))] = {x.x, x.y, x.z};
    }
}

bool ContactSurface::counts(int a, int b) const {
    if (body(a) == body(b) && !touches_itself_) return false;
    return !(is_held(a) && is_held(b)) && (share_a_vertex(a, b) || !share_a_knot(a, b));
}

bool ContactSurface::share_a_vertex(int a, int b) const {
    return std::ranges::any_of(triangle(a),
                               [&](int v) { return std::ranges::count(triangle(b), v) != 0; });
}

std::vector<TrianglePair> ContactSurface::crossings(const BoxTree& tree) const {
    return find_crossings(surface(), tree, [this](int a, int b) { return counts(a, b); });
}

bool ContactSurface::is_held(int t) const {
    return std::ranges::all_of(triangle(t),
                               [&](int v) { return held_[static_cast<std::size_t>(v)] != 0; });
}

bool ContactSurface::share_a_knot(int a, int b) const {
    return std::ranges::any_of(triangle(a), [&](int v) {
        return std::ranges::find(triangle(b), knot(v), [&](int w) { return knot(w); }) !=
               triangle(b).end();
    });
}

std::string body_name(const BodyRange& body) {
    return fmt::format("{} '{}'", body.kind, body.name);
}

std::string triangle_name(const Model& model, int triangle) {
    const BodyRange& body = model.bodies[model.body_of_triangle(triangle)];
    return fmt::format("{} triangle {}", body_name(body), triangle - body.first_triangle);
}

std::string name_of_pair(const Model& model, const TrianglePair& pair) {
    return triangle_name(model, pair[0]) + " and " + triangle_name(model, pair[1]);
}

std::string text_of_crossings(const Model& model, const std::vector<TrianglePair>& pairs,
                              std::size_t most) {
    std::vector<std::string> named;
    for (std::size_t i = 0; i < std::min(pairs.size(), most); ++i) {
        named.push_back(name_of_pair(model, pairs[i]));
    }
    return fmt::format("{} pair{} of triangles cross{}: {}{}", pairs.size(),
                       pairs.size() == 1 ? "" : "s", pairs.size() == 1 ? "es" : "",
                       fmt::join(named, "; "), pairs.size() > most ? "; ..." : "");
}

}  // namespace weft
