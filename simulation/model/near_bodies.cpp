#include "simulation/model/near_bodies.h"

#include <algorithm>
#include <set>

#include "runtime/tbb/parallel.h"
#include "simulation/mesh/crossings.h"
#include "simulation/model/triangle_distance.h"

namespace weft {

namespace {

constexpr std::size_t kSamples = 2000;

using Bodies = std::array<int, 2>;  ///< ascending

Bodies in_order(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Of things that stand body by body: whose each is. first: of a body, the number of its first one
std::vector<int> bodies_of(std::size_t count, const std::vector<BodyRange>& bodies,
                           int BodyRange::*first) {
    std::vector<int> of(count);
    std::size_t body = 0;
    for (std::size_t i = 0; i < count; ++i) {
        while (body + 1 < bodies.size() && bodies[body + 1].*first <= static_cast<int>(i)) ++body;
        of[i] = static_cast<int>(body);
    }
    return of;
}

/// Bodies that have an element in common.
std::set<Bodies> tied_bodies(const Gathered& all) {
    const std::vector<int> body = bodies_of(all.rest.size(), all.bodies, &BodyRange::first_vertex);
    std::set<Bodies> tied;
    for (const auto& family : all.families) {
        const Stencils& stencils = family->stencils();
        const auto arity = at(stencils.arity);
        for (std::size_t i = 0; i < stencils.vertices.size(); i += arity) {
            const int first = body[at(stencils.vertices[i])];
            for (std::size_t k = 1; k < arity; ++k) {
                const int other = body[at(stencils.vertices[i + k])];
                if (other != first) tied.insert(in_order(first, other));
            }
        }
    }
    return tied;
}

Corners corners_of(const Gathered& all, int t) {
    const auto& v = all.triangles[at(t)];
    return {all.rest[at(v[0])], all.rest[at(v[1])], all.rest[at(v[2])]};
}

bool is_held(const Gathered& all, int t) {
    return std::ranges::all_of(all.triangles[at(t)], [&](int v) {
        return all.held[at(v)] != 0 || all.masses[at(v)] <= 0.0;
    });
}

/// Of those that may move, all or every so-many-th.
std::vector<int> sample_of(const Gathered& all) {
    std::vector<int> free;
    for (int t = 0; t < static_cast<int>(all.triangles.size()); ++t) {
        if (!is_held(all, t)) free.push_back(t);
    }
    const std::size_t step = 1 + free.size() / kSamples;
    std::vector<int> sample;
    for (std::size_t i = 0; i < free.size(); i += step) sample.push_back(free[i]);
    return sample;
}

}  // namespace

std::vector<double> distances_to_others(const Gathered& all, double within) {
    if (all.bodies.size() < 2) return {};
    const std::vector<int> sample = sample_of(all);
    const std::vector<int> body =
        bodies_of(all.triangles.size(), all.bodies, &BodyRange::first_triangle);
    const std::set<Bodies> tied = tied_bodies(all);
    const BoxTree tree = PlainSurface{all.rest, all.triangles}.tree();
    std::vector<double> distances(sample.size(), within);
    for_each_block(static_cast<int>(sample.size()), [&](int /*block*/, int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const int a = sample[at(i)];
            double& least = distances[at(i)];
            tree.visit(tree.box(a).grown(within), [&](int b) {
                if (body[at(a)] == body[at(b)]) return;
                if (tied.contains(in_order(body[at(a)], body[at(b)]))) return;
                least = std::min(least, distance_of(corners_of(all, a), corners_of(all, b)));
            });
        }
    });
    std::ranges::sort(distances);
    return distances;
}

}  // namespace weft
