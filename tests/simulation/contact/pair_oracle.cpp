#include "tests/simulation/contact/pair_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "simulation/families/convert.h"

namespace weft::test {

namespace {

/// Of lengths and of angles: what single precision cannot tell apart.
constexpr double kRounding = 2e-5;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

std::vector<int> patches_of(const std::vector<int>& begin) {
    std::vector<int> patches;
    for (std::size_t p = 0; p + 1 < begin.size(); ++p) {
        patches.insert(patches.end(), index(begin[p + 1] - begin[p]), static_cast<int>(p));
    }
    return patches;
}

template <class A, class B>
bool share(const A& a, const B& b) {
    return std::ranges::any_of(a, [&](int v) { return std::ranges::find(b, v) != b.end(); });
}

/// Where groups begin: 8 patches of a strip each.
std::vector<int> groups_of_patches(const std::vector<int>& strip_patches) {
    std::vector<int> begin{0};
    for (std::size_t s = 0; s + 1 < strip_patches.size(); ++s) {
        for (int first = strip_patches[s]; first < strip_patches[s + 1]; first += 8) {
            begin.push_back(std::min(first + 8, strip_patches[s + 1]));
        }
    }
    return begin;
}

/// Of two answers to one question.
Verdict both_of(bool surely, bool perhaps) {
    return surely ? Verdict::kPushing : (perhaps ? Verdict::kEither : Verdict::kNone);
}

}  // namespace

PairOracle::PairOracle(const ContactMesh& mesh, const Surface& surface,
                       const PairSettings& settings)
    : mesh_(mesh),
      surface_(surface),
      settings_(settings),
      patch_of_vertex_(patches_of(surface.patch_vertices)),
      patch_of_triangle_(patches_of(surface.patch_triangles)),
      patch_of_edge_(patches_of(surface.patch_edges)) {
    for (int p = 0; p < surface.patch_count(); ++p) patches_.push_back(patch(p));
    group_begin_ = groups_of_patches(surface.strip_patches);
    groups_ = find_groups(surface, group_begin_);
    for (int g = 0; g < groups_.beside.count(); ++g) group_patches_.push_back(group(g));
}

template <class A, class B>
bool PairOracle::share_a_knot(const A& a, const B& b) const {
    const auto knot = [&](int v) { return mesh_.mesh.knots[index(surface_.vertices[index(v)])]; };
    return std::ranges::any_of(
        a, [&](int v) { return std::ranges::find(b, knot(v), knot) != b.end(); });
}

Vec3 PairOracle::at(int vertex) const {
    return to_vec3(mesh_.anchors[index(surface_.vertices[index(vertex)])]);
}

double PairOracle::reach(int vertex) const {
    return static_cast<double>(mesh_.anchors[index(surface_.vertices[index(vertex)])].w);
}

PairOracle::Patch PairOracle::patch(int p) const {
    Patch patch;
    double height = 1e30;
    double farthest = 0.0;
    std::vector<Vec3> normals;
    std::set<int> faces;
    for (int t = 0; t < surface_.triangle_count(); ++t) {
        if (patch_of_triangle_[index(t)] == p) faces.insert(t);
    }
    for (const int t : surface_.faces[p]) faces.insert(t);
    for (const int t : faces) {
        const auto& x = surface_.triangles[index(t)];
        normals.push_back(cross(at(x[1]) - at(x[0]), at(x[2]) - at(x[0])));
        patch.mean = patch.mean + normals.back();
        const auto rest = [&](std::size_t k) {
            return mesh_.mesh.rest[index(surface_.vertices[index(x[k])])];
        };
        double longest = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            farthest = std::max(farthest, reach(x[k]));
            longest = std::max(longest, length(rest(k) - rest((k + 1) % 3)));
        }
        const double area = length(cross(rest(1) - rest(0), rest(2) - rest(0)));
        height = std::min(height, longest > 0.0 ? area / longest : 0.0);
    }
    if (length(patch.mean) < kRounding) return patch;
    patch.mean = normalized(patch.mean);
    double least = 1.0;
    for (const Vec3& n : normals) {
        least = std::min(least, length(n) > 0.0 ? dot(normalized(n), patch.mean) : -1.0);
    }
    const double spare = std::min(0.4 * height - farthest, least - std::sqrt(0.75));
    patch.flat = spare > 0.0;
    patch.near_limit = std::abs(spare) < kRounding;
    return patch;
}

/// Its patches have to be near each other's way by 15 degrees.
PairOracle::Patch PairOracle::group(int g) const {
    Patch group{true, false, {}};
    const auto own = std::span(patches_).subspan(
        index(group_begin_[index(g)]), index(group_begin_[index(g + 1)] - group_begin_[index(g)]));
    for (const Patch& p : own) group.mean = group.mean + p.mean;
    group.mean = normalized(group.mean);
    for (const Patch& p : own) {
        const double spare = dot(p.mean, group.mean) - 0.9659;
        group.flat = group.flat && p.flat && spare > 0.0;
        group.near_limit = group.near_limit || p.near_limit || std::abs(spare) < kRounding;
    }
    return group;
}

int PairOracle::flat_groups() const {
    int count = 0;
    for (int g = 0; g < groups_.beside.count(); ++g) {
        const auto list = groups_.beside[g];
        const bool is_inside = std::ranges::find(list, g) != list.end();
        count += is_inside && group_patches_[index(g)].flat;
    }
    return count;
}

Verdict PairOracle::is_sheet(const std::array<Patch, 3>& parts, double cosine) {
    bool flat = true;
    bool near_limit = false;
    for (const Patch& a : parts) {
        near_limit = near_limit || a.near_limit;
        flat = flat && a.flat;
        for (const Patch& b : parts) {
            const double spare = &a == &b ? 1.0 : dot(a.mean, b.mean) - cosine;
            near_limit = near_limit || std::abs(spare) < kRounding;
            flat = flat && spare > 0.0;
        }
    }
    if (near_limit) return Verdict::kEither;
    return flat ? Verdict::kNone : Verdict::kPair;
}

Verdict PairOracle::near(int p, int q) const {
    const bool same_body = surface_.patch_body[index(p)] == surface_.patch_body[index(q)];
    if (!settings_.self && same_body) return Verdict::kNone;
    if (surface_.patch_held[index(p)] != 0 && surface_.patch_held[index(q)] != 0) {
        return Verdict::kNone;
    }
    const auto by_lists = [](const Lists& beside, const std::vector<int>& between, int a, int b,
                             double cosine, auto part) {
        const auto list = beside[a];
        const auto found = std::ranges::find(list, b);
        if (found == list.end()) return Verdict::kPair;
        const int via =
            between[index(beside.begin[index(a)]) + static_cast<std::size_t>(found - list.begin())];
        return is_sheet({part(a), part(b), part(via)}, cosine);
    };
    const Verdict patches = by_lists(surface_.beside, surface_.between, p, q, 0.5,
                                     [&](int n) { return patches_[index(n)]; });
    const Verdict groups = by_lists(groups_.beside, groups_.between, groups_.of_patch[index(p)],
                                    groups_.of_patch[index(q)], 0.8660,
                                    [&](int n) { return group_patches_[index(n)]; });
    if (patches == Verdict::kNone || groups == Verdict::kNone) return Verdict::kNone;
    return patches == Verdict::kEither || groups == Verdict::kEither ? Verdict::kEither
                                                                     : Verdict::kPair;
}

/// In single precision: so it is defined.
template <class A, class B>
bool PairOracle::boxes_meet(const A& a, const B& b) const {
    const auto bounds = [&](const auto& vertices, int axis) {
        float low = 3e38f;
        float high = -3e38f;
        for (const int v : vertices) {
            const float4& x = mesh_.anchors[index(surface_.vertices[index(v)])];
            const float c = axis == 0 ? x.x : axis == 1 ? x.y : x.z;
            const float q = x.w + 0.25f * settings_.thickness;
            low = std::min(low, c - q);
            high = std::max(high, c + q);
        }
        return std::pair(low, high);
    };
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = bounds(a, axis);
        const auto [other_low, other_high] = bounds(b, axis);
        if (!(low <= other_high && high >= other_low)) return false;
    }
    return true;
}

PairOracle::Distance PairOracle::to_triangle(int vertex, const std::array<int, 3>& t) const {
    const Vec3 p = at(vertex);
    const std::array<Vec3, 3> x{at(t[0]), at(t[1]), at(t[2])};
    Distance best;
    const auto consider = [&](double a, double b, double c) {
        const Vec3 way = p - (a * x[0] + b * x[1] + c * x[2]);
        if (length(way) < best.d) best = {length(way), best.on_a_side, way, {a, b, c}};
    };
    const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
    if (dot(n, n) > 1e-10 * dot(x[1] - x[0], x[1] - x[0]) * dot(x[2] - x[0], x[2] - x[0])) {
        const double b = dot(cross(p - x[0], x[2] - x[0]), n) / dot(n, n);
        const double c = dot(cross(x[1] - x[0], p - x[0]), n) / dot(n, n);
        if (b > 0.0 && c > 0.0 && b + c < 1.0) consider(1.0 - b - c, b, c);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 side = x[(k + 1) % 3] - x[k];
        const double square = dot(side, side);
        const double s = square > 0.0 ? std::clamp(dot(p - x[k], side) / square, 0.0, 1.0) : 0.0;
        std::array<double, 3> w{};
        w[k] = 1.0 - s;
        w[(k + 1) % 3] = s;
        best.on_a_side = std::min(best.on_a_side, length(p - x[k] - s * side));
        consider(w[0], w[1], w[2]);
    }
    return best;
}

PairOracle::Distance PairOracle::between(int edge, int other) const {
    const auto& e = surface_.edges[index(std::min(edge, other))];
    const auto& f = surface_.edges[index(std::max(edge, other))];
    const Vec3 a = at(e[0]);
    const Vec3 b = at(f[0]);
    const Vec3 u = at(e[1]) - a;
    const Vec3 v = at(f[1]) - b;
    Distance best;
    const auto consider = [&](double s, double t) {
        const Vec3 way = a + s * u - b - t * v;
        if (length(way) < best.d) best = {length(way), 1e30, way, {1.0 - s, s, 1.0 - t, t}};
    };
    const Vec3 n = cross(u, v);
    if (dot(n, n) > 1e-10 * dot(u, u) * dot(v, v)) {
        const double s = dot(cross(v, a - b), n) / dot(n, n);
        const double t = dot(cross(u, a - b), n) / dot(n, n);
        if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) consider(s, t);
    }
    const auto foot = [](Vec3 way, Vec3 side) {
        return dot(side, side) > 0.0 ? std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0) : 0.0;
    };
    consider(0.0, foot(a - b, v));
    consider(1.0, foot(a + u - b, v));
    consider(foot(b - a, u), 0.0);
    consider(foot(b + v - a, u), 1.0);
    return best;
}

Verdict PairOracle::verdict(double d, double reaches, Verdict pushes) const {
    const double to_meet = reaches + static_cast<double>(settings_.least) - d;
    const double to_push = reaches + 0.5 * static_cast<double>(settings_.thickness) - d;
    if (to_push < -kRounding) return Verdict::kNone;
    if (std::abs(to_push) < kRounding || std::abs(to_meet) < kRounding) return Verdict::kEither;
    if (to_meet > 0.0) {
        return pushes == Verdict::kNone ? Verdict::kPair : pushes;
    }
    return pushes;
}

/// A face, an edge or a corner pushes what is in its part of space, and once.
Verdict PairOracle::pushes(int vertex, int triangle, const Distance& d) const {
    const auto& t = surface_.triangles[index(triangle)];
    if (d.d < kRounding) return Verdict::kEither;
    if (std::ranges::any_of(d.weights, [](double w) { return w > 0.0 && w < kRounding; })) {
        return Verdict::kEither;
    }
    std::vector<int> support;
    for (std::size_t k = 0; k < 3; ++k) {
        if (d.weights[k] > 0.0) support.push_back(t[k]);
    }
    // Where another foot is as near, on a side or at its end, single precision may take that one.
    const double tie = 4.0 * double{std::numeric_limits<float>::epsilon()} * d.d * d.d;
    if (support.size() == 3) {
        const double farther = d.on_a_side * d.on_a_side - d.d * d.d;
        return farther < tie ? Verdict::kEither : Verdict::kPushing;
    }
    if (support.size() == 2) {
        const auto weight = [](double w) { return w > 0.0 ? w : 1.0; };
        const double end =
            std::min({weight(d.weights[0]), weight(d.weights[1]), weight(d.weights[2])}) *
            length(at(support[0]) - at(support[1]));
        if (end * end < tie) return Verdict::kEither;
    }
    const Vec3 n = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    if (length(n) < 1e-3) return Verdict::kEither;
    int lowest = -1;
    for (int other = surface_.triangle_count() - 1; other >= 0; --other) {
        const auto& x = surface_.triangles[index(other)];
        const bool has_all =
            std::ranges::all_of(support, [&](int v) { return std::ranges::find(x, v) != x.end(); });
        if (has_all) lowest = other;
    }
    if (lowest != triangle) return Verdict::kNone;
    bool surely = true;
    bool perhaps = true;
    const auto ask = [&](double value) {
        surely = surely && value > kRounding;
        perhaps = perhaps && value > -kRounding;
    };
    if (support.size() == 1) {
        const int corner = support.front();
        if (!(vertex < corner)) return Verdict::kNone;
        for (const auto& e : surface_.edges) {
            if (e[0] == corner) ask(dot(d.way, at(corner) - at(e[1])));
            if (e[1] == corner) ask(dot(d.way, at(corner) - at(e[0])));
        }
        return both_of(surely, perhaps);
    }
    int others = 0;
    for (const auto& x : surface_.triangles) {
        if (&x == &t || !share(x, std::vector{support[0]}) || !share(x, std::vector{support[1]})) {
            continue;
        }
        for (const int v : x) {
            if (v == support[0] || v == support[1]) continue;
            if (others++ == 0) ask(dot(d.way, at(vertex) - d.way - at(v)));
        }
    }
    return both_of(surely, perhaps);
}

Verdict PairOracle::vertex_triangle(int vertex, int triangle) const {
    const auto& t = surface_.triangles[index(triangle)];
    const std::array<int, 1> v{vertex};
    if (share_a_knot(v, t) || !boxes_meet(v, t)) return Verdict::kNone;
    const Verdict together =
        near(patch_of_vertex_[index(vertex)], patch_of_triangle_[index(triangle)]);
    if (together == Verdict::kNone) return together;
    const Distance d = to_triangle(vertex, t);
    const double reaches = reach(vertex) + std::max({reach(t[0]), reach(t[1]), reach(t[2])});
    const Verdict found = verdict(d.d, reaches, pushes(vertex, triangle, d));
    return together == Verdict::kEither && found != Verdict::kNone ? Verdict::kEither : found;
}

Verdict PairOracle::edge_edge(int edge, int other) const {
    const auto& e = surface_.edges[index(edge)];
    const auto& f = surface_.edges[index(other)];
    if (share_a_knot(e, f) || !boxes_meet(e, f)) return Verdict::kNone;
    const Verdict together = near(patch_of_edge_[index(edge)], patch_of_edge_[index(other)]);
    if (together == Verdict::kNone) return together;
    const Distance d = between(edge, other);
    const Vec3 u = at(e[1]) - at(e[0]);
    const Vec3 v = at(f[1]) - at(f[0]);
    const bool inside = std::ranges::all_of(d.weights, [](double w) { return w > 0.0; });
    // The nearer to parallel, the worse is known where they cross.
    const double sine = length(cross(u, v)) / (length(u) * length(v));
    const double limit = (kRounding + 1e-3 * d.d / length(u)) / std::max(sine, 1e-9);
    const bool at_limit =
        std::ranges::any_of(d.weights, [&](double w) { return w > 0.0 && w < limit; });
    const Verdict pushing =
        at_limit ? Verdict::kEither : (inside ? Verdict::kPushing : Verdict::kNone);
    const double reaches = std::max(reach(e[0]), reach(e[1])) + std::max(reach(f[0]), reach(f[1]));
    const Verdict found = verdict(d.d, reaches, pushing);
    return together == Verdict::kEither && found != Verdict::kNone ? Verdict::kEither : found;
}

}  // namespace weft::test
