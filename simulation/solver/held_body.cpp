#include "simulation/solver/held_body.h"

#include <algorithm>
#include <iterator>

#include "simulation/families/convert.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

/// How far the middle of cloth is from its hinge, of its farthest vertex, at least: of a sheet it
/// is half of it.
constexpr double kToOneSide = 0.25;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Whether a body goes as a whole. Solids do. Cloth does where it hangs to one side of a line or a
/// point that it turns about: between places that hold it, it sags by bending, and what pulls at
/// these says nothing of its middle. (Cloth held at opposite corners fell by a quarter less than
/// before.)
bool goes_as_a_whole(const Model& model, const FreeBodies::Whole& body, const BodyHinge& hinge) {
    if (is_solid(model, body.begin, body.end)) return true;
    if (!hinge.can_turn) return false;
    const auto place = [&](int v) { return to_vec3((*model.positions)[at(v)]); };
    const Vec3 from = place(hinge.from);
    const Vec3 line = place(hinge.to) - from;
    const double size = length(line);
    const Vec3 axis = size > 0.0 ? (1.0 / size) * line : Vec3{};
    Vec3 sum;
    double mass = 0.0;
    double farthest = 0.0;
    for (int v = body.begin; v < body.end; ++v) {
        const Vec3 r = place(v) - from;
        const Vec3 across = r - dot(r, axis) * axis;
        sum = sum + model.masses[at(v)] * across;
        mass += model.masses[at(v)];
        farthest = std::max(farthest, length(across));
    }
    return length(sum) > kToOneSide * mass * farthest;
}

}  // namespace

bool is_held(const Model& model, int vertex) { return (*model.positions)[at(vertex)].w <= 0.0f; }

std::vector<HeldBody> movable_bodies(const Model& model) {
    const std::vector<int> begins = component_begins(model.vertex_count(), model.stencils());
    std::vector<HeldBody> bodies;
    for (std::size_t body = 0; body + 1 < begins.size(); ++body) {
        const int begin = begins[body];
        const int end = begins[body + 1];
        std::vector<int> held;
        for (int v = begin; v < end; ++v) {
            if (is_held(model, v)) held.push_back(v);
        }
        if (end - begin < 2 || std::ssize(held) == end - begin) continue;
        const int middle = (begin + end) / 2;
        const BodyHinge hinge =
            held.empty() ? BodyHinge{middle, middle, false} : hinge_of(model, held);
        const FreeBodies::Whole whole{begin, end, hinge.from};
        const bool goes = held.empty() || goes_as_a_whole(model, whole, hinge);
        bodies.push_back({whole, std::move(held), hinge, goes});
    }
    return bodies;
}

std::vector<HeldBody> held_bodies(const Model& model) {
    std::vector<HeldBody> bodies = movable_bodies(model);
    std::erase_if(bodies, [&](const HeldBody& body) {
        return body.vertices.empty() || !body.goes_as_a_whole;
    });
    return bodies;
}

std::vector<FreeBodies::Whole> wholes_of(const std::vector<HeldBody>& bodies) {
    std::vector<FreeBodies::Whole> wholes;
    for (const auto& body : bodies) wholes.push_back(body.whole);
    return wholes;
}

}  // namespace weft
