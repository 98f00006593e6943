#include "tests/simulation/contact/contact_meshes.h"

#include <cmath>
#include <functional>
#include <numeric>

#include "simulation/families/convert.h"

namespace weft::test {

namespace {

using Place = std::function<Vec3(int sheet, int column, int row)>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// In strips, in whose order everything then is.
void order(ContactMesh& m, int strip_vertices) {
    Stencils triangles{3, {}};
    for (const auto& t : m.mesh.triangles) {
        triangles.vertices.insert(triangles.vertices.end(), t.begin(), t.end());
    }
    StripOptions options;
    options.min_vertices_per_strip = strip_vertices;
    const int count = static_cast<int>(m.mesh.rest.size());
    m.strips = make_strips(count, std::vector{triangles}, options);
    for (auto& t : m.mesh.triangles) {
        for (int& v : t) v = m.strips.rank[at(v)];
    }
    const auto reorder = [&](auto& values) {
        auto sorted = values;
        for (int v = 0; v < count; ++v) sorted[at(v)] = values[at(m.strips.order[at(v)])];
        values = std::move(sorted);
    };
    reorder(m.mesh.rest);
    reorder(m.mesh.held);
    reorder(m.mesh.knots);
    reorder(m.anchors);
}

void add_vertex(ContactMesh& m, Vec3 rest, Vec3 anchor, float reach) {
    m.mesh.knots.push_back(static_cast<int>(m.mesh.rest.size()));
    m.mesh.rest.push_back(rest);
    m.mesh.held.push_back(0);
    m.anchors.push_back(to_float4(anchor, static_cast<double>(reach)));
}

constexpr int kSmallStrips = 40;

ContactMesh sheets(const std::string& name, int count, int width, int height, float thickness,
                   float reach, const Place& place, int strip_vertices = kSmallStrips) {
    ContactMesh m;
    m.name = name;
    m.thickness = thickness;
    for (int sheet = 0; sheet < count; ++sheet) {
        const int first = static_cast<int>(m.mesh.rest.size());
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                const Vec3 rest{column + (width + 5.0) * sheet, 0.0, row + 0.0};
                add_vertex(m, rest, place(sheet, column, row), reach);
            }
        }
        for (int row = 0; row + 1 < height; ++row) {
            for (int column = 0; column + 1 < width; ++column) {
                const int v = first + row * width + column;
                m.mesh.triangles.push_back({v, v + width, v + 1});
                m.mesh.triangles.push_back({v + 1, v + width, v + width + 1});
                m.mesh.triangle_body.insert(m.mesh.triangle_body.end(), 2, sheet);
            }
        }
    }
    order(m, strip_vertices);
    return m;
}

/// Triangles without any order: many at one edge, some collapsed.
ContactMesh soup(unsigned seed, int vertices, int triangles, bool degenerate) {
    Random random(seed);
    ContactMesh m;
    m.name = degenerate ? "degenerate soup" : "soup";
    m.thickness = 0.1f;
    for (int v = 0; v < vertices; ++v) {
        float4 x = random.point(1.5f);
        if (degenerate) x = {std::round(x.x), std::round(x.y), std::round(2.0f * x.z), 0.0f};
        const float reach = degenerate && v % 3 == 0 ? 0.0f : random.real(0.0f, 0.2f);
        add_vertex(m, to_vec3(x), to_vec3(x), reach);
    }
    for (int t = 0; t < triangles; ++t) {
        const int a = random.integer(0, vertices - 40);
        m.mesh.triangles.push_back({a, a + random.integer(1, 20), a + random.integer(1, 39)});
        m.mesh.triangle_body.push_back(0);
    }
    order(m, kSmallStrips);
    return m;
}

/// Ties the last column of sheet 0 to the first of sheet 1, and every fifth vertex of sheet 0 to
/// that of sheet 2.
void tie_sheets(ContactMesh& m, int width, int height) {
    const int size = width * height;
    std::vector<int> same(m.mesh.rest.size());
    std::iota(same.begin(), same.end(), 0);
    for (int row = 0; row < height; ++row) same[at(size + row * width)] = row * width + width - 1;
    for (int v = 0; v < size; v += 5) same[at(2 * size + v)] = v;
    for (int& knot : m.mesh.knots) knot = same[at(knot)];
}

Vec3 shaken(Vec3 x, double size, Random& random) {
    const float4 by = random.point(static_cast<float>(size));
    return x + to_vec3(by);
}

}  // namespace

ContactMesh flat_sheet(int size) {
    return sheets("flat", 1, size, size, 0.3f, 0.2f, [](int, int column, int row) {
        return Vec3{column + 0.0, 0.0, row + 0.0};
    });
}

ContactMesh stack(int layers, int size, float gap, float thickness, float reach) {
    Random random(5);
    return sheets("stack", layers, size, size, thickness, reach,
                  [&](int sheet, int column, int row) {
                      const Vec3 x{column + 0.37 * sheet, static_cast<double>(gap) * sheet,
                                   row + 0.21 * sheet};
                      return shaken(x, 0.02, random);
                  });
}

std::vector<ContactMesh> contact_meshes() {
    Random random(9);
    std::vector<ContactMesh> all;
    all.push_back(stack(3, 9, 0.2f, 0.3f, 0.1f));
    // Exactly above each other: parallel edges, vertices above vertices.
    all.push_back(sheets("aligned", 2, 8, 8, 0.3f, 0.1f, [](int sheet, int column, int row) {
        return Vec3{column + 0.0, 0.25 * sheet, row + 0.0};
    }));
    // Folded three times, the layers a fifth of an edge apart.
    all.push_back(sheets("folded", 1, 8, 40, 0.3f, 0.1f, [&](int, int column, int row) {
        const int layer = row / 10;
        const int along = layer % 2 == 0 ? row % 10 : 9 - row % 10;
        return shaken({column + 0.0, 0.2 * layer, along + 0.0}, 0.03, random);
    }));
    // A tube of five edges around: adjacent patches that are not flat.
    all.push_back(sheets("tube", 1, 6, 30, 0.3f, 0.1f, [&](int, int column, int row) {
        const double angle = 1.2 * column;
        return shaken({std::cos(angle), row + 0.0, std::sin(angle)}, 0.02, random);
    }));
    all.push_back(sheets("crumpled", 2, 12, 12, 0.2f, 0.1f,
                         [&](int, int, int) { return shaken({}, 2.0, random); }));
    all.push_back(sheets("in one place", 1, 7, 7, 0.2f, 0.1f, [](int, int, int) {
        return Vec3{1.0, 2.0, 3.0};
    }));
    // Two sheets in one plane, sewn together where their borders lie upon each other, and a third
    // one above that is tied to the first in places.
    all.push_back(sheets("sewn", 3, 8, 12, 0.3f, 0.1f, [&](int sheet, int column, int row) {
        const bool above = sheet == 2;
        return shaken({column + 7.0 * (sheet % 2), above ? 0.2 : 0.0, row + (above ? 0.3 : 0.0)},
                      above ? 0.05 : 0.0, random);
    }));
    tie_sheets(all.back(), 8, 12);
    all.push_back(soup(1, 150, 120, false));
    all.push_back(soup(2, 150, 120, true));
    all.push_back(flat_sheet(12));
    // Folded twice, so large, and in such strips, that groups of patches lie amid a layer; the
    // first layer and the last one face the same way.
    all.push_back(sheets(
        "large folded", 1, 26, 78, 0.3f, 0.1f,
        [&](int, int column, int row) {
            const int layer = row / 26;
            const int along = layer % 2 == 0 ? row % 26 : 25 - row % 26;
            return shaken({column - 13.0, 0.12 * layer, along - 13.0}, 0.02, random);
        },
        300));
    all.push_back(stack(3, 9, 0.2f, 0.3f, 0.1f));
    all.back().name = "not with itself";
    all.back().self = false;
    all.push_back(stack(3, 9, 0.2f, 0.3f, 0.1f));
    all.back().name = "two layers held";
    for (std::size_t t = 0; t < all.back().mesh.triangles.size(); ++t) {
        if (all.back().mesh.triangle_body[t] == 0) continue;
        for (const int v : all.back().mesh.triangles[t]) all.back().mesh.held[at(v)] = 1;
    }
    return all;
}

}  // namespace weft::test
