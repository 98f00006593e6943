#include "simulation/mesh/crossings.h"

#include <gtest/gtest.h>

#include <random>

#include "simulation/mesh/generators.h"
#include "simulation/mesh/winding.h"

namespace weft {
namespace {

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<std::array<int, 3>> triangles;

    void add(const std::vector<Vec3>& more, const std::vector<std::array<int, 3>>& faces) {
        const int first = static_cast<int>(positions.size());
        // By way of a buffer: GCC 12 leaves the rounding out of a cast to float and back.
        std::vector<float> rounded;
        for (const Vec3& p : more) {
            for (const double x : {p.x, p.y, p.z}) rounded.push_back(static_cast<float>(x));
        }
        for (std::size_t i = 0; i < rounded.size(); i += 3) {
            positions.push_back({rounded[i], rounded[i + 1], rounded[i + 2]});
        }
        for (const auto& t : faces) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    void add_triangle(Vec3 a, Vec3 b, Vec3 c) { add({a, b, c}, {{0, 1, 2}}); }
    /// n x n vertices from -1 to 1, where `at` puts (u, v).
    template <class At>
    void add_sheet(int n, At at) {
        std::vector<Vec3> points;
        std::vector<std::array<int, 3>> faces;
        for (int k = 0; k < n; ++k) {
            for (int i = 0; i < n; ++i) {
                points.push_back(at(2.0 * i / (n - 1) - 1.0, 2.0 * k / (n - 1) - 1.0));
                if (i + 1 == n || k + 1 == n) continue;
                const int v = k * n + i;
                faces.push_back({v, v + 1, v + n});
                faces.push_back({v + 1, v + n + 1, v + n});
            }
        }
        add(points, faces);
    }

    std::vector<TrianglePair> crossings() const {
        const PlainSurface surface{positions, triangles};
        return find_crossings(surface, surface.tree(), [](int, int) { return true; });
    }
};

/// Whether a segment goes through a triangle, in the plainest way, for points in general position.
bool pierces(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    const double at_p = dot(p - a, n), at_q = dot(q - a, n);
    if ((at_p > 0.0) == (at_q > 0.0)) return false;
    const Vec3 x = p + (at_p / (at_p - at_q)) * (q - p);
    return dot(cross(b - a, x - a), n) > 0.0 && dot(cross(c - b, x - b), n) > 0.0 &&
           dot(cross(a - c, x - c), n) > 0.0;
}

bool triangles_cross(const PlainSurface& s, int t, int u) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (pierces(s.corner(t, k), s.corner(t, next), s.corner(u, 0), s.corner(u, 1),
                    s.corner(u, 2)) ||
            pierces(s.corner(u, k), s.corner(u, next), s.corner(t, 0), s.corner(t, 1),
                    s.corner(t, 2))) {
            return true;
        }
    }
    return false;
}

TEST(Crossings, AreThoseOfAllPairsInOrder) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f), size(-0.3f, 0.3f);
    const auto random = [&](auto& d) { return Vec3{d(generator), d(generator), d(generator)}; };
    Mesh mesh;
    for (int t = 0; t < 3000; ++t) {
        const Vec3 at = random(place);
        mesh.add_triangle(at, at + random(size), at + random(size));
    }
    const PlainSurface surface{mesh.positions, mesh.triangles};
    std::vector<TrianglePair> expected;
    for (int t = 0; t < 3000; ++t) {
        for (int u = t + 1; u < 3000; ++u) {
            if (triangles_cross(surface, t, u)) expected.push_back({t, u});
        }
    }
    EXPECT_GT(expected.size(), 1000u);
    EXPECT_EQ(mesh.crossings(), expected);
}

TEST(Crossings, CountOnlyPairsThatAreAskedFor) {
    Mesh mesh;
    mesh.add_triangle({-1, 0, -1}, {1, 0, -1}, {0, 0, 1});
    mesh.add_triangle({0, -1, -0.5}, {0.1, 1, -0.5}, {0, 1, 0.5});
    const PlainSurface surface{mesh.positions, mesh.triangles};
    EXPECT_EQ(mesh.crossings(), (std::vector<TrianglePair>{{0, 1}}));
    EXPECT_TRUE(find_crossings(surface, surface.tree(), [](int, int) { return false; }).empty());
}

Vec3 flat(double u, double v) { return {u, 0.0, v}; }
Vec3 upright(double u, double v) { return {0.0, u, v}; }

TEST(Crossings, AreNoneInAFlatOrRolledSheet) {
    Mesh mesh;
    mesh.add_sheet(9, flat);
    EXPECT_TRUE(mesh.crossings().empty());
    Mesh tilted;
    tilted.add_sheet(9, [](double u, double v) { return Vec3{u, 0.3 * u + 0.7 * v, v}; });
    EXPECT_EQ(tilted.crossings(), std::vector<TrianglePair>{});
    Mesh roll;  // three turns, a tenth apart
    roll.add_sheet(60, [](double u, double v) {
        const double angle = 10.0 * u, radius = 1.0 + 0.01 * angle;
        return Vec3{radius * std::cos(angle), radius * std::sin(angle), v};
    });
    EXPECT_TRUE(roll.crossings().empty());
}

TEST(Crossings, AreNoneWhereSurfacesTouch) {
    Mesh same;  // in one place
    same.add_sheet(5, flat);
    same.add_sheet(5, flat);
    EXPECT_TRUE(same.crossings().empty());
    Mesh shifted;  // in one plane
    shifted.add_sheet(5, flat);
    shifted.add_sheet(5, [](double u, double v) { return Vec3{u + 0.3, 0.0, v - 0.2}; });
    EXPECT_TRUE(shifted.crossings().empty());
    Mesh standing;  // on its edge, on edges and vertices of the other
    standing.add_sheet(5, flat);
    standing.add_sheet(5, [](double u, double v) { return Vec3{0.0, u + 1.0, v}; });
    EXPECT_TRUE(standing.crossings().empty());
    Mesh seam;  // two panels whose edges lie in one place, bent
    seam.add_sheet(5, flat);
    seam.add_sheet(5, [](double u, double v) { return Vec3{2.0 + u, u + 1.0, v}; });
    EXPECT_TRUE(seam.crossings().empty());
    Mesh tip;
    tip.add_sheet(5, flat);
    tip.add_triangle({0.1, 0, 0.2}, {0.2, 1, 0.2}, {0.1, 1, 0.5});
    EXPECT_TRUE(tip.crossings().empty());
}

TEST(Crossings, AreSeenWhereVerticesLieInTheOtherSurface) {
    Mesh odd;  // edges through edges, vertices on vertices
    odd.add_sheet(5, flat);
    odd.add_sheet(5, upright);
    EXPECT_FALSE(odd.crossings().empty());
    Mesh inside;  // vertices on faces
    inside.add_sheet(5, flat);
    inside.add_sheet(5, [](double u, double v) { return Vec3{0.1, u, v + 0.05}; });
    EXPECT_FALSE(inside.crossings().empty());
    Mesh even;  // no vertex in the plane
    even.add_sheet(5, flat);
    even.add_sheet(6, upright);
    EXPECT_FALSE(even.crossings().empty());
}

TEST(Crossings, OfASheetWithItself) {
    Mesh mesh;  // a loop that goes through itself
    mesh.add_sheet(20, [](double u, double v) {
        const double t = 3.0 * u;
        return Vec3{t * t * t - 4.0 * t, t * t, v};
    });
    EXPECT_FALSE(mesh.crossings().empty());
    Mesh corner;  // triangles with one vertex in common
    corner.add({{0, 0, 0}, {2, 0, -1}, {2, 0, 1}, {1, -1, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 3, 4}});
    EXPECT_EQ(corner.crossings(), (std::vector<TrianglePair>{{0, 1}}));
    Mesh folded;  // along an edge, onto itself
    folded.add({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.2, 0, 0.5}}, {{0, 1, 2}, {1, 0, 3}});
    EXPECT_TRUE(folded.crossings().empty());
}

TEST(Crossings, TrianglesWithoutAreaDoNoHarm) {
    Mesh mesh;
    mesh.add_sheet(5, flat);
    mesh.add_triangle({0.1, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0.1});
    mesh.add_triangle({-0.5, 0, 0.1}, {0.1, 0, 0.1}, {0.5, 0, 0.1});
    EXPECT_TRUE(mesh.crossings().empty());
    mesh.add_triangle({0.1, -1, 0.1}, {0.1, 1, 0.1}, {0.1, 0.5, 0.1});
    EXPECT_FALSE(mesh.crossings().empty());
}

TEST(Winding, TellsInsideFromOutside) {
    Mesh cube;
    cube.add(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
        {{0, 2, 1},
         {1, 2, 3},
         {4, 5, 6},
         {5, 7, 6},
         {0, 1, 4},
         {1, 5, 4},
         {2, 6, 3},
         {3, 6, 7},
         {0, 4, 2},
         {2, 4, 6},
         {1, 3, 5},
         {3, 7, 5}});
    const PlainSurface surface{cube.positions, cube.triangles};
    EXPECT_NEAR(winding_number(surface, 0, 12, {0.3, 0.2, 0.9}), 1.0, 1e-12);
    EXPECT_NEAR(winding_number(surface, 0, 12, {1.3, 0.2, 0.9}), 0.0, 1e-12);
}

}  // namespace
}  // namespace weft
