#include "simulation/contact/notches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

namespace weft::test {
namespace {

constexpr double kPi = std::numbers::pi;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Strips one_strip(int vertices) {
    Strips strips;
    strips.order.resize(at(vertices));
    std::iota(strips.order.begin(), strips.order.end(), 0);
    strips.rank = strips.order;
    strips.begin = {0, vertices};
    return strips;
}

/// Cells of a square grid in one strip, each of two triangles. A cell's corner is a vertex of its
/// own per side, where `side` tells cells apart.
struct Cells {
    int size;
    std::function<bool(int x, int y)> is_cut = [](int, int) { return false; };
    std::function<int(int corner_x, int corner_y, int cell_x)> side = [](int, int, int) {
        return 0;
    };

    double gap = 0.0;  ///< between sides [m]

    SurfaceMesh mesh() const {
        SurfaceMesh mesh;
        std::map<std::array<int, 3>, int> numbers;
        const auto vertex = [&](int x, int y, int cell_x) {
            const auto [found, is_new] =
                numbers.try_emplace({x, y, side(x, y, cell_x)}, static_cast<int>(numbers.size()));
            if (is_new) mesh.rest.push_back({0.1 * x + gap * side(x, y, cell_x), 0.0, 0.1 * y});
            return found->second;
        };
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                if (is_cut(x, y)) continue;
                const int a = vertex(x, y, x), b = vertex(x + 1, y, x);
                const int c = vertex(x, y + 1, x), d = vertex(x + 1, y + 1, x);
                mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
            }
        }
        mesh.triangle_body.assign(mesh.triangles.size(), 0);
        mesh.held.assign(mesh.rest.size(), 0);
        mesh.knots.resize(mesh.rest.size());
        std::iota(mesh.knots.begin(), mesh.knots.end(), 0);
        return mesh;
    }

    Surface surface() const {
        const SurfaceMesh mesh = this->mesh();
        return make_surface(mesh, one_strip(static_cast<int>(mesh.rest.size())));
    }

    std::vector<double> notches() const { return border_notches(surface(), mesh().rest); }
};

/// Open from the middle of the sheet to its far side.
Cells slit(int size, double gap) {
    const auto side = [=](int x, int y, int cell_x) {
        return 2 * x == size && 2 * y > size && 2 * cell_x >= size ? 1 : 0;
    };
    return {size, [](int, int) { return false; }, side, gap};
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(Notches, OfASquareAreNone) { EXPECT_NEAR(sum(Cells{6}.notches()), 0.0, 1e-12); }

TEST(Notches, OfAnInnerCornerAreARightAngle) {
    const auto notches = Cells{6, [](int x, int y) { return x >= 3 && y >= 3; }}.notches();
    EXPECT_NEAR(sum(notches), kPi / 2.0, 1e-12);
    EXPECT_NEAR(std::ranges::max(notches), kPi / 2.0, 1e-12);
}

TEST(Notches, OfAHoleAreAllOfItsTurn) {
    const auto is_hole = [](int x, int y) { return std::min(x, y) >= 2 && std::max(x, y) < 4; };
    EXPECT_NEAR(sum(Cells{6, is_hole}.notches()), 2.0 * kPi, 1e-12);
}

TEST(Notches, OfASlitAreHalfATurnAtItsEnd) {
    const auto notches = slit(6, 0.0).notches();
    EXPECT_NEAR(sum(notches), kPi, 1e-12);
    EXPECT_NEAR(std::ranges::max(notches), kPi, 1e-12);
}

TEST(Notches, WhereTwoPiecesMeetInAVertexAreMoreThanAnyTurn) {
    const auto is_cut = [](int x, int y) { return (x < 3) != (y < 3); };
    EXPECT_GT(std::ranges::max(Cells{6, is_cut}.notches()), 4.0 * kPi);
}

TEST(Notches, WhereThreeTrianglesShareAnEdgeAreMoreThanAnyTurn) {
    SurfaceMesh mesh = Cells{1}.mesh();
    mesh.rest.push_back({0.05, 0.1, 0.05});
    mesh.triangles.push_back({1, 2, 4});
    mesh.triangle_body.push_back(0);
    mesh.held.push_back(0);
    mesh.knots.push_back(4);
    const Surface s = make_surface(mesh, one_strip(5));
    EXPECT_GT(std::ranges::max(border_notches(s, mesh.rest)), 4.0 * kPi);
}

/// A border that is straight leaves no room for a slit, so patches along it hang together as those
/// inside do.
TEST(Notches, ASquareHangsTogetherAlongItsBorder) {
    const Surface s = Cells{16}.surface();
    const auto touching = [&](int p) {
        std::set<int> all;
        for (const int v : s.hulls[p]) all.insert(s.patches_at[v].begin(), s.patches_at[v].end());
        return all;
    };
    for (int p = 0; p < s.patch_count(); ++p) {
        const std::set beside(s.beside[p].begin(), s.beside[p].end());
        for (const int via : touching(p)) {
            for (const int q : touching(via)) EXPECT_TRUE(beside.contains(q)) << p << ", " << q;
        }
    }
}

/// On which sides of the slit a patch has edges of it: bits.
int sides_of_slit(const Surface& s, const std::vector<Vec3>& rest, int patch, double middle) {
    int sides = 0;
    for (const int t : s.faces[patch]) {
        double x = 0.0;
        int on_slit = 0;
        for (const int v : s.triangles[at(t)]) {
            const Vec3 place = rest[at(s.vertices[at(v)])];
            x += place.x / 3.0;
            on_slit += place.z > middle - 0.05 && std::abs(place.x - middle) < 0.05 ? 1 : 0;
        }
        if (on_slit == 2) sides |= x < middle + 0.02 ? 1 : 2;
    }
    return sides;
}

/// How many of a surface's patches have edges of the slit.
int expect_that_sides_are_apart(double gap) {
    constexpr double kMiddle = 1.6;
    const Cells cells = slit(32, gap);
    const Surface s = cells.surface();
    const auto rest = cells.mesh().rest;
    int count = 0;
    for (int p = 0; p < s.patch_count(); ++p) {
        const int own = sides_of_slit(s, rest, p, kMiddle);
        count += own > 0 ? 1 : 0;
        for (const int q : s.beside[p]) {
            const int its = sides_of_slit(s, rest, q, kMiddle);
            const bool are_across = ((own & 1) != 0 && its >= 2) || ((its & 1) != 0 && own >= 2);
            EXPECT_FALSE(are_across) << p << " and " << q;
        }
    }
    return count;
}

/// One side may lie on the other one while both are flat.
TEST(Notches, SidesOfASlitDoNotHangTogether) {
    EXPECT_GT(expect_that_sides_are_apart(0.04), 6);
    EXPECT_GT(expect_that_sides_are_apart(0.0), 4) << "patches have vertices of both sides";
}

}  // namespace
}  // namespace weft::test
