// The kernels' own energy, in double precision.
#define WEFT_IN_DOUBLE

#include "simulation/model/tetrahedra.h"

#include "kernels/energies/tetrahedron.h"

namespace weft {

namespace {

Vec3 at(std::span<const Vec3> rest, int vertex) { return rest[static_cast<std::size_t>(vertex)]; }

kernels::real3 at(std::span<const float4> positions, int vertex) {
    const float4& x = positions[static_cast<std::size_t>(vertex)];
    return kernels::make3(static_cast<double>(x.x), static_cast<double>(x.y),
                          static_cast<double>(x.z));
}

kernels::tetrahedron deformed(const Tetrahedra& all, int tetrahedron,
                              std::span<const float4> positions) {
    const auto b = [&](int corner) {
        const Vec3 gradient = all.shape_gradient(tetrahedron, corner);
        return kernels::make3(gradient.x, gradient.y, gradient.z);
    };
    const auto v = all.elements.vertices_of(tetrahedron);
    return kernels::make_tetrahedron(
        kernels::tetrahedron_map(at(positions, v[0]), at(positions, v[1]), at(positions, v[2]),
                                 at(positions, v[3]), b(1), b(2), b(3)),
        all.mu(tetrahedron), all.lambda(tetrahedron));
}

}  // namespace

Tetrahedra::Tetrahedra(const Stencils& tetrahedra, const Strips& strips, std::span<const Vec3> rest,
                       std::span<const Stiffness> stiffness)
    : elements("tetrahedra", tetrahedra, strips),
      shape("tetrahedra.shape", 9 * static_cast<std::size_t>(elements.count())),
      material("tetrahedra.material", 2 * static_cast<std::size_t>(elements.count())) {
    const auto count = static_cast<std::size_t>(elements.count());
    for (std::size_t t = 0; t < count; ++t) {
        const int original = elements.original(static_cast<int>(t));
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

Vec3 Tetrahedra::shape_gradient(int tetrahedron, int corner) const {
    const auto row = [&](int k) {
        return Vec3{column(shape, 3 * k, tetrahedron), column(shape, 3 * k + 1, tetrahedron),
                    column(shape, 3 * k + 2, tetrahedron)};
    };
    return corner > 0 ? row(corner - 1) : -(row(0) + row(1) + row(2));
}

double Tetrahedra::energy(std::span<const float4> positions) const {
    double sum = 0.0;
    for (int t = 0; t < elements.count(); ++t) {
        sum += kernels::tetrahedron_energy(deformed(*this, t, positions));
    }
    return sum;
}

double Tetrahedra::stretch(int tetrahedron, std::span<const float4> positions) const {
    const kernels::mat3 map = deformed(*this, tetrahedron, positions).map;
    return std::sqrt(
        (kernels::dot3(map.x, map.x) + kernels::dot3(map.y, map.y) + kernels::dot3(map.z, map.z)) /
        3.0);
}

}  // namespace weft
