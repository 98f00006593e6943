#include "simulation/mesh/generators.h"

#include <numbers>

namespace weft {
namespace {

/// How far along its row a vertex lies, from 0 to 1, exactly at both ends.
double fraction(int index, int last) { return static_cast<double>(index) / last; }

void finish(TriangleMesh& mesh, std::string name) {
    mesh.source = name;
    mesh.parts = {{std::move(name), 0, mesh.triangle_count()}};
}

std::vector<Vec3>& reserved(TriangleMesh& mesh, std::array<int, 2> resolution) {
    const auto vertices = static_cast<std::size_t>(resolution[0]) * resolution[1];
    mesh.positions.reserve(vertices);
    mesh.triangles.reserve(2 * vertices);
    return mesh.positions;
}

/// Cuts the cell of corners a, b (one row) and c, d (next row) along b-c.
void add_cell(TriangleMesh& mesh, int a, int b, int c, int d, bool flip) {
    if (flip) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
    } else {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
    }
}

/// From the cell's lowest corner to its highest, along one axis after the other: each order of the
/// three axes is a tetrahedron. offset: from a vertex to its neighbour on each axis.
void add_cell(TetMesh& mesh, int lowest, const std::array<int, 3>& offset) {
    constexpr std::array<std::array<std::size_t, 2>, 6> kFirstTwoAxes{
        {{0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};
    const int highest = lowest + offset[0] + offset[1] + offset[2];
    for (std::size_t i = 0; i < kFirstTwoAxes.size(); ++i) {
        const auto [first, second] = kFirstTwoAxes[i];
        const int one = lowest + offset[first];
        const int two = one + offset[second];
        const bool is_even = i < 3;  // as a permutation of the axes
        if (is_even)
            mesh.tetrahedra.push_back({lowest, one, two, highest});
        else
            mesh.tetrahedra.push_back({lowest, two, one, highest});
    }
}

/// is_there(i, j): whether the cells there are, along the whole depth.
template <class IsThere>
TetMesh make_cells(std::array<double, 3> size, std::array<int, 3> resolution, IsThere is_there) {
    TetMesh mesh;
    mesh.source = "block";
    const auto [nx, ny, nz] = resolution;
    const auto at = [&](std::size_t axis, int index) {
        return size[axis] * (fraction(index, resolution[axis] - 1) - 0.5);
    };
    for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) mesh.positions.push_back({at(0, i), at(1, j), at(2, k)});
        }
    }
    for (int k = 0; k + 1 < nz; ++k) {
        for (int j = 0; j + 1 < ny; ++j) {
            for (int i = 0; i + 1 < nx; ++i) {
                if (!is_there(i, j)) continue;
                add_cell(mesh, (k * ny + j) * nx + i, {1, nx, nx * ny});
            }
        }
    }
    return mesh;
}

/// Whether the middle of cell (i, j) is in a '#'.
bool is_filled(const std::vector<std::string>& outline, const std::array<int, 3>& resolution, int i,
               int j) {
    const auto place = [](int cell, int cells, std::size_t places) {
        return (2 * static_cast<std::size_t>(cell) + 1) * places /
               (2 * static_cast<std::size_t>(cells));
    };
    const int columns = resolution[0] - 1;
    const int rows = resolution[1] - 1;
    const std::string& row = outline[place(rows - 1 - j, rows, outline.size())];
    return row[place(i, columns, row.size())] == '#';
}

/// Removes vertices that no tetrahedron has.
void drop_unused(TetMesh& mesh) {
    std::vector<int> number(mesh.positions.size(), -1);
    for (const auto& t : mesh.tetrahedra) {
        for (const int v : t) number[static_cast<std::size_t>(v)] = 0;
    }
    std::vector<Vec3> kept;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(kept.size());
        kept.push_back(mesh.positions[v]);
    }
    mesh.positions = std::move(kept);
    for (auto& t : mesh.tetrahedra) {
        for (int& v : t) v = number[static_cast<std::size_t>(v)];
    }
}

}  // namespace

TriangleMesh make_grid(std::array<double, 2> size, std::array<int, 2> resolution) {
    TriangleMesh mesh;
    const auto [nx, nz] = resolution;
    std::vector<Vec3>& positions = reserved(mesh, resolution);
    for (int k = 0; k < nz; ++k) {
        for (int i = 0; i < nx; ++i) {
            positions.push_back({size[0] * (fraction(i, nx - 1) - 0.5), 0.0,
                                 size[1] * (fraction(k, nz - 1) - 0.5)});
        }
    }
    for (int k = 0; k + 1 < nz; ++k) {
        for (int i = 0; i + 1 < nx; ++i) {
            const int a = k * nx + i;
            add_cell(mesh, a, a + 1, a + nx, a + nx + 1, false);
        }
    }
    finish(mesh, "grid");
    return mesh;
}

TriangleMesh make_cylinder(std::array<double, 2> radius, double height,
                           std::array<int, 2> resolution) {
    TriangleMesh mesh;
    const auto [around, along] = resolution;
    std::vector<Vec3>& positions = reserved(mesh, resolution);
    for (int k = 0; k < along; ++k) {
        const double down = fraction(k, along - 1);
        const double r = radius[0] + down * (radius[1] - radius[0]);
        for (int i = 0; i < around; ++i) {
            const double angle = 2.0 * std::numbers::pi * fraction(i, around);
            positions.push_back({r * std::cos(angle), height * (0.5 - down), r * std::sin(angle)});
        }
    }
    for (int k = 0; k + 1 < along; ++k) {
        for (int i = 0; i < around; ++i) {
            const int a = k * around + i;
            const int b = k * around + (i + 1) % around;
            add_cell(mesh, a, b, a + around, b + around, true);
        }
    }
    finish(mesh, "cylinder");
    return mesh;
}

TetMesh make_block(std::array<double, 3> size, std::array<int, 3> resolution) {
    return make_cells(size, resolution, [](int, int) { return true; });
}

TetMesh make_outlined_block(std::array<double, 3> size, std::array<int, 3> resolution,
                            const std::vector<std::string>& outline) {
    TetMesh mesh = make_cells(size, resolution,
                              [&](int i, int j) { return is_filled(outline, resolution, i, j); });
    drop_unused(mesh);
    return mesh;
}

double outlined_vertex_count(std::array<int, 3> resolution,
                             const std::vector<std::string>& outline) {
    const auto [nx, ny, nz] = resolution;
    const auto there = [&](int i, int j) {
        return i >= 0 && j >= 0 && i + 1 < nx && j + 1 < ny && is_filled(outline, resolution, i, j);
    };
    double count = 0.0;
    for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
            if (there(i, j) || there(i - 1, j) || there(i, j - 1) || there(i - 1, j - 1)) ++count;
        }
    }
    return count * nz;
}

}  // namespace weft
