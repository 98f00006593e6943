#include "simulation/mesh/crossings.h"

#include <algorithm>

#include "runtime/tbb/parallel.h"
#include "simulation/mesh/orientation.h"

namespace weft {

namespace {

/// What of a triangle is met: all of its corners that the place lies between. One: that vertex,
/// two: that edge, three: its inside.
using Feature = std::vector<int>;

/// A place on the lines through the triangle's edges by its signs there: on which side of the edge
/// from corner k to corner k + 1 it lies. Empty: outside.
Feature feature_at(const std::array<int, 3>& triangle, std::array<int, 3> signs) {
    const int turn = signs[0] + signs[1] + signs[2];
    if (turn == 0) return {};  // outside, or a triangle without area
    Feature feature;
    for (std::size_t k = 0; k < 3; ++k) {
        if (signs[k] * turn < 0) return {};
        // Away from the edge opposite to a corner, that corner takes part.
        if (signs[k] != 0) feature.push_back(triangle[(k + 2) % 3]);
    }
    return feature;
}

class CrossingTest {
public:
    explicit CrossingTest(const PlainSurface& surface)
        : surface_(surface), stars_(surface.positions.size() + 1) {
        for (const auto& t : surface.triangles) {
            for (const int v : t) ++stars_[static_cast<std::size_t>(v) + 1];
        }
        for (std::size_t v = 1; v < stars_.size(); ++v) stars_[v] += stars_[v - 1];
        star_triangles_.resize(3 * surface.triangles.size());
        std::vector<int> place(stars_.begin(), stars_.end() - 1);
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            for (const int v : surface.triangles[t]) {
                star_triangles_[static_cast<std::size_t>(place[static_cast<std::size_t>(v)]++)] =
                    static_cast<int>(t);
            }
        }
    }

    bool cross(int a, int b) const { return goes_through(a, b) || goes_through(b, a); }

private:
    const std::array<int, 3>& corners(int triangle) const {
        return surface_.triangles[static_cast<std::size_t>(triangle)];
    }
    Vec3 at(int vertex) const { return surface_.positions[static_cast<std::size_t>(vertex)]; }
    std::span<const int> star(int vertex) const {
        const auto v = static_cast<std::size_t>(vertex);
        return {star_triangles_.data() + stars_[v], star_triangles_.data() + stars_[v + 1]};
    }
    bool has(int triangle, int vertex) const {
        return std::ranges::count(corners(triangle), vertex) != 0;
    }
    int side(int triangle, int vertex) const {
        const auto& t = corners(triangle);
        return side_of(at(t[0]), at(t[1]), at(t[2]), at(vertex));
    }

    bool goes_through(int mover, int wall) const {
        const auto& m = corners(mover);
        const Bounds box = surface_.bounds(wall);
        for (std::size_t k = 0; k < 3; ++k) {
            const int p = m[k], q = m[(k + 1) % 3];
            if (has(wall, p) || has(wall, q)) continue;
            Bounds of_edge{at(p), at(p)};
            of_edge.include({at(q), at(q)});
            if (of_edge.overlaps(box) && edge_goes_through(p, q, wall, box)) return true;
        }
        return false;
    }

    bool edge_goes_through(int p, int q, int wall, const Bounds& box) const {
        const int at_p = side(wall, p);
        const int at_q = side(wall, q);
        if (at_p * at_q < 0) return straddle({{p, q}}, wall, feature_on_line(p, q, wall));
        return (at_p == 0 && box.overlaps({at(p), at(p)}) && vertex_goes_through(p, wall)) ||
               (at_q == 0 && box.overlaps({at(q), at(q)}) && vertex_goes_through(q, wall));
    }

    Feature feature_on_line(int p, int q, int wall) const {
        const auto& t = corners(wall);
        std::array<int, 3> signs{};
        for (std::size_t k = 0; k < 3; ++k) {
            signs[k] = side_of(at(p), at(q), at(t[k]), at(t[(k + 1) % 3]));
        }
        return feature_at(t, signs);
    }

    /// Of a vertex in the wall's plane.
    bool vertex_goes_through(int v, int wall) const {
        std::vector<int> ring;
        for (const int t : star(v)) {
            ring.insert(ring.end(), corners(t).begin(), corners(t).end());
        }
        return straddle(ring, wall, feature_in_plane(v, wall));
    }

    Feature feature_in_plane(int v, int wall) const {
        const auto& t = corners(wall);
        for (int axis = 0; axis < 3; ++axis) {
            if (turn_of(at(t[0]), at(t[1]), at(t[2]), axis) == 0) continue;
            std::array<int, 3> signs{};
            for (std::size_t k = 0; k < 3; ++k) {
                signs[k] = turn_of(at(t[k]), at(t[(k + 1) % 3]), at(v), axis);
            }
            return feature_at(t, signs);
        }
        return {};
    }

    /// Whether some of the points lie on the one side and some on the other of all triangles that
    /// meet at the feature. Beyond a border they may do so without a crossing.
    bool straddle(std::span<const int> points, int wall, const Feature& feature) const {
        if (feature.empty()) return false;
        if (feature.size() == 3) return straddle(points, wall);
        std::vector<int> walls;
        for (const int t : star(feature.front())) {
            if (feature.size() == 1 || has(t, feature.back())) walls.push_back(t);
        }
        if (is_at_border(feature, walls)) return false;
        return std::ranges::all_of(walls, [&](int t) { return straddle(points, t); });
    }

    bool straddle(std::span<const int> points, int wall) const {
        int low = 0, high = 0;
        for (const int v : points) {
            const int s = side(wall, v);
            low = std::min(low, s);
            high = std::max(high, s);
        }
        return low < 0 && high > 0;
    }

    bool is_at_border(const Feature& feature, const std::vector<int>& walls) const {
        if (feature.size() == 2) return walls.size() < 2;
        std::vector<int> others;  // those inside the surface come twice
        for (const int t : walls) {
            for (const int v : corners(t)) {
                if (v != feature.front()) others.push_back(v);
            }
        }
        return std::ranges::any_of(others,
                                   [&](int v) { return std::ranges::count(others, v) == 1; });
    }

    const PlainSurface& surface_;
    std::vector<int> stars_;  ///< [vertices + 1] where each one's begin in star_triangles_
    std::vector<int> star_triangles_;
};

}  // namespace

Bounds PlainSurface::bounds(int triangle) const {
    Bounds box{corner(triangle, 0), corner(triangle, 0)};
    for (const std::size_t k : {1U, 2U}) box.include({corner(triangle, k), corner(triangle, k)});
    return box;
}

BoxTree PlainSurface::tree() const {
    std::vector<Bounds> boxes;
    boxes.reserve(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) boxes.push_back(bounds(static_cast<int>(t)));
    return BoxTree(std::move(boxes));
}

std::vector<TrianglePair> find_crossings(const PlainSurface& surface, const BoxTree& tree,
                                         const std::function<bool(int, int)>& counts) {
    const CrossingTest test(surface);
    std::vector<std::vector<TrianglePair>> found(
        static_cast<std::size_t>(block_count(tree.count())));
    for_each_block(tree.count(), [&](int block, int begin, int end) {
        auto& pairs = found[static_cast<std::size_t>(block)];
        for (int a = begin; a < end; ++a) {
            tree.visit(tree.box(a), [&](int b) {
                if (b > a && counts(a, b) && test.cross(a, b)) pairs.push_back({a, b});
            });
        }
        std::ranges::sort(pairs);
    });
    std::vector<TrianglePair> all;
    for (const auto& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
    return all;
}

}  // namespace weft
