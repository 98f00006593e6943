#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

Vec3 at(std::span<const Vec3> rest, int vertex) { return rest[static_cast<std::size_t>(vertex)]; }

}  // namespace

Tetrahedra::Tetrahedra(const FamilyNames& names, const Stencils& tetrahedra, const Strips& strips,
                       std::span<const Vec3> rest, std::span<const Stiffness> stiffness)
    : ElementFamily(names, tetrahedra, strips),
      shape("tetrahedra.shape", 9 * static_cast<std::size_t>(tetrahedra.count())),
      material("tetrahedra.material", 2 * static_cast<std::size_t>(tetrahedra.count())) {
    const auto count = static_cast<std::size_t>(tetrahedra.count());
    for (std::size_t t = 0; t < count; ++t) {
        const int original = elements().original(static_cast<int>(t));
        const auto v = tetrahedra[original];
        const Vec3 e1 = at(rest, v[1]) - at(rest, v[0]);
        const Vec3 e2 = at(rest, v[2]) - at(rest, v[0]);
        const Vec3 e3 = at(rest, v[3]) - at(rest, v[0]);
        const double six_volumes = dot(cross(e1, e2), e3);
        // Rows of the inverse of the matrix whose columns are the edges.
        const std::array<Vec3, 3> b{(1.0 / six_volumes) * cross(e2, e3),
                                    (1.0 / six_volumes) * cross(e3, e1),
                                    (1.0 / six_volumes) * cross(e1, e2)};
        for (std::size_t k = 0; k < 3; ++k) {
            shape[(3 * k + 0) * count + t] = static_cast<float>(b[k].x);
            shape[(3 * k + 1) * count + t] = static_cast<float>(b[k].y);
            shape[(3 * k + 2) * count + t] = static_cast<float>(b[k].z);
        }
        const Stiffness& s = stiffness[static_cast<std::size_t>(original)];
        material[t] = static_cast<float>(s.mu * six_volumes / 6.0);
        material[count + t] = static_cast<float>(s.lambda * six_volumes / 6.0);
    }
}

std::array<double, 3> Tetrahedra::shape_gradient(int tetrahedron, int corner) const {
    const auto row = [&](int k) {
        return Vec3{column(shape, 3 * k, tetrahedron), column(shape, 3 * k + 1, tetrahedron),
                    column(shape, 3 * k + 2, tetrahedron)};
    };
    const Vec3 b = corner > 0 ? row(corner - 1) : -(row(0) + row(1) + row(2));
    return {b.x, b.y, b.z};
}

void Tetrahedra::add_edges(std::vector<Edge>& edges) const {
    for (int t = 0; t < count(); ++t) {
        std::array<Vec3, 3> b;
        for (int k = 0; k < 3; ++k) {
            const auto [x, y, z] = shape_gradient(t, k + 1);
            b[static_cast<std::size_t>(k)] = {x, y, z};
        }
        add_edges_of(corners(t), b, edges);
    }
}

}  // namespace weft
