#include "simulation/model/load_paths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "simulation/model/spans.h"
#include "simulation/topology/vertex_graph.h"

namespace weft {

namespace {

constexpr int kFar = -1;
constexpr int kHere = -2;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

VertexGraph make_graph(const Gathered& all, std::span<const Stencils> links) {
    std::vector<Stencils> kinds(links.begin(), links.end());
    Stencils triangles{3, {}};
    for (const auto& t : all.triangles) {
        triangles.vertices.insert(triangles.vertices.end(), t.begin(), t.end());
    }
    kinds.push_back(std::move(triangles));
    return {static_cast<int>(all.rest.size()), kinds};
}

/// Goes through all that hangs together with the front, level by level; the front is on level 0.
/// levels  [vertices] kFar where nobody was yet. Returns whom it met, by level.
std::vector<int> flood(const VertexGraph& graph, std::vector<int> front, std::vector<int>& levels) {
    for (const int v : front) levels[at(v)] = 0;
    for (std::size_t next = 0; next < front.size(); ++next) {
        for (const int w : graph.neighbours(front[next])) {
            if (levels[at(w)] != kFar) continue;
            levels[at(w)] = levels[at(front[next])] + 1;
            front.push_back(w);
        }
    }
    return front;
}

class PathFinder {
public:
    PathFinder(const Gathered& all, std::span<const Stencils> links, Vec3 gravity)
        : all_(all),
          down_(length(gravity) > 0.0 ? normalized(gravity) : Vec3{}),
          graph_(make_graph(all, links)),
          spans_(all, down_),
          seen_(all.rest.size(), kFar),
          levels_(seen_) {
        for (const BodyRange& body : all.bodies) {
            const auto first = all.held.begin() + body.first_vertex;
            const auto is_held = [](auto held) { return held != 0; };
            all_held_.push_back(std::all_of(first, first + body.vertex_count, is_held) ? 1 : 0);
        }
    }

    std::vector<LoadPath> find() {
        std::vector<LoadPath> paths;
        for (int v = 0; v < graph_.vertex_count(); ++v) {
            if (seen_[at(v)] != kFar) continue;
            const std::vector<int> part = flood(graph_, {v}, seen_);
            if (part.size() > 1) paths.push_back(path_of(part));
        }
        return paths;
    }

private:
    LoadPath path_of(const std::vector<int>& part) {
        LoadPath path;
        path.is_held = std::ranges::any_of(part, [&](int v) { return all_.held[at(v)] != 0; });
        path.levels = levels_of(part);
        path.edge = mean_edge(part);
        const std::map<std::size_t, double> masses = masses_of(part);
        double mass = 0.0;
        for (const auto& [body, own] : masses) mass += own;
        const auto lightest =
            std::ranges::min_element(masses, {}, [](const auto& entry) { return entry.second; });
        path.body = all_.bodies[lightest->first].name;
        path.burden = lightest->second > 0.0 ? mass / lightest->second : 1.0;
        path.is_solid = std::ranges::all_of(
            masses, [&](const auto& entry) { return all_.bodies[entry.first].kind == "solid"; });
        if (path.is_solid && path.is_held) {
            path.slender = std::max(1.0, path.levels * path.edge / thickness_of(part));
        }
        if (path.is_held && length(down_) > 0.0) {
            add_bending(path, part, masses);
            spans_.add_to(path, part, masses);
        }
        return path;
    }

    void add_bending(LoadPath& path, const std::vector<int>& part,
                     const std::map<std::size_t, double>& masses) {
        const bool is_cloth = std::ranges::all_of(
            masses, [&](const auto& entry) { return all_.bodies[entry.first].kind == "cloth"; });
        if (!is_cloth && !path.is_solid) return;
        double reach = 0.0;
        double firmness = 0.0;
        double mass = 0.0;
        for (const auto& [number, own] : masses) {
            const auto& [density, stiffness] = all_.bearings[number];
            if (stiffness <= 0.0) continue;
            if (reach == 0.0) reach = reach_of(part, path.is_solid);
            const double across = path.is_solid ? thickness_of(part) : 1.0;
            const double factor = path.is_solid ? 1.5 : 0.125;
            path.softness = std::max(path.softness, factor * density * std::pow(reach, 3) /
                                                        (stiffness * across * across));
            firmness += firmness_of(number);
            mass += own;
        }
        path.firmness = mass > 0.0 ? firmness / mass : 0.0;
    }

    /// The sum over a body's vertices [N/m].
    double firmness_of(std::size_t number) {
        if (firmness_.empty()) {
            firmness_.resize(all_.rest.size(), 0.0);
            for (const auto& family : all_.families) {
                family->add_firmness(all_.rest, down_, firmness_);
            }
        }
        const auto first = firmness_.begin() + all_.bodies[number].first_vertex;
        return std::accumulate(first, first + all_.bodies[number].vertex_count, 0.0);
    }

    /// How far the farthest vertex is from the held one that it hangs on: along the path, or
    /// straight across gravity [m].
    double reach_of(const std::vector<int>& part, bool across) {
        std::vector<int> front;
        for (const int v : part) {
            levels_[at(v)] = kFar;
            if (all_.held[at(v)] != 0) front.push_back(v);
        }
        from_held_.resize(all_.rest.size());
        for (const int v : front) {
            levels_[at(v)] = kHere;
            from_held_[at(v)] = {};
        }
        double reach = 0.0;
        for (std::size_t next = 0; next < front.size(); ++next) {
            const int v = front[next];
            reach = std::max(reach, length(from_held_[at(v)]));
            for (const int w : graph_.neighbours(v)) {
                if (levels_[at(w)] != kFar) continue;
                levels_[at(w)] = kHere;
                const Vec3 edge = all_.rest[at(w)] - all_.rest[at(v)];
                from_held_[at(w)] = across ? from_held_[at(v)] + edge - dot(edge, down_) * down_
                                           : from_held_[at(v)] + Vec3{length(edge), 0.0, 0.0};
                front.push_back(w);
            }
        }
        return reach;
    }

    /// Four times volume over surface: that of a long bar with a square across [m].
    double thickness_of(const std::vector<int>& part) {
        for (const int v : part) levels_[at(v)] = kHere;
        double volume = 0.0;
        double area = 0.0;
        for (const auto& [a, b, c] : all_.triangles) {
            if (levels_[at(a)] != kHere) continue;
            const Vec3 from = all_.rest[at(part.front())];
            const Vec3 x = all_.rest[at(a)] - from;
            const Vec3 normal =
                cross(all_.rest[at(b)] - all_.rest[at(a)], all_.rest[at(c)] - all_.rest[at(a)]);
            volume += dot(x, normal) / 6.0;
            area += 0.5 * length(normal);
        }
        for (const int v : part) levels_[at(v)] = kFar;
        return std::max(4.0 * std::abs(volume) / std::max(area, 1e-18), 1e-9);
    }

    /// Of the bodies that the part belongs to and that pins do not hold all over, if there are any:
    /// the others carry nothing. A solid's inside is on no triangle: it counts whole.
    std::map<std::size_t, double> masses_of(const std::vector<int>& part) const {
        std::map<std::size_t, double> masses;
        const auto is_free = [&](int v) { return all_held_[body_of(v)] == 0; };
        const bool is_any_free = std::ranges::any_of(part, is_free);
        for (const int v : part) {
            if (!is_any_free || is_free(v)) masses[body_of(v)] += all_.masses[at(v)];
        }
        for (auto& [number, mass] : masses) {
            const BodyRange& body = all_.bodies[number];
            if (body.kind != "solid") continue;
            const auto first = all_.masses.begin() + body.first_vertex;
            mass = std::accumulate(first, first + body.vertex_count, 0.0);
        }
        return masses;
    }

    double levels_of(const std::vector<int>& part) {
        std::vector<int> held;
        for (const int v : part) {
            if (all_.held[at(v)] != 0) held.push_back(v);
        }
        if (!held.empty()) return farthest(held, part).second;
        return 0.5 * farthest({farthest({part.front()}, part).first}, part).second;
    }

    /// A vertex of the part that is farthest from the front, and its level.
    std::pair<int, int> farthest(const std::vector<int>& front, const std::vector<int>& part) {
        for (const int v : part) levels_[at(v)] = kFar;
        const int last = flood(graph_, front, levels_).back();
        return {last, levels_[at(last)]};
    }

    double mean_edge(const std::vector<int>& part) const {
        double sum = 0.0;
        double count = 0.0;
        for (const int v : part) {
            for (const int w : graph_.neighbours(v)) {
                sum += length(all_.rest[at(v)] - all_.rest[at(w)]);
                count += 1.0;
            }
        }
        return sum / count;
    }

    std::size_t body_of(int vertex) const {
        const auto behind =
            std::ranges::upper_bound(all_.bodies, vertex, {}, &BodyRange::first_vertex);
        return static_cast<std::size_t>(behind - all_.bodies.begin()) - 1;
    }

    const Gathered& all_;
    Vec3 down_;  ///< 0: without gravity
    VertexGraph graph_;
    Spans spans_;
    std::vector<int> seen_, levels_;  ///< [vertices]
    std::vector<int> all_held_;       ///< [bodies] 1: pins hold all of it
    std::vector<Vec3> from_held_;     ///< [vertices] [m]
    std::vector<double> firmness_;    ///< [vertices] [N/m]
};

}  // namespace

std::vector<LoadPath> load_paths(const Gathered& all, std::span<const Stencils> links,
                                 Vec3 gravity) {
    return PathFinder(all, links, gravity).find();
}

}  // namespace weft
