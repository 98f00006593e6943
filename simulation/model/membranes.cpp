// The kernels' own energy, in double precision.
#define WEFT_IN_DOUBLE

#include "simulation/model/membranes.h"

#include "kernels/energies/membrane.h"

namespace weft {

namespace {

kernels::real3 at(std::span<const float4> positions, int vertex) {
    const float4& x = positions[static_cast<std::size_t>(vertex)];
    return kernels::make3(static_cast<double>(x.x), static_cast<double>(x.y),
                          static_cast<double>(x.z));
}

kernels::membrane deformed(const Membranes& all, int triangle, std::span<const float4> positions) {
    const auto b = [&](int corner) {
        const auto [u, v] = all.shape_gradient(triangle, corner);
        return kernels::make2(u, v);
    };
    const auto v = all.elements.vertices_of(triangle);
    return kernels::make_membrane(at(positions, v[0]), at(positions, v[1]), at(positions, v[2]),
                                  b(1), b(2), all.mu(triangle), all.lambda(triangle));
}

}  // namespace

Membranes::Membranes(const Stencils& triangles, const Strips& strips, std::span<const Vec3> rest,
                     std::span<const Stiffness> stiffness)
    : elements("membranes", triangles, strips),
      shape("membranes.shape", 4 * static_cast<std::size_t>(elements.count())),
      material("membranes.material", 2 * static_cast<std::size_t>(elements.count())) {
    const auto count = static_cast<std::size_t>(elements.count());
    for (std::size_t t = 0; t < count; ++t) {
        const int original = elements.original(static_cast<int>(t));
        const auto v = triangles[original];
        const auto at_rest = [&](int k) {
            return rest[static_cast<std::size_t>(v[static_cast<std::size_t>(k)])];
        };
        // The plane's axes: u along the first edge, v across it.
        const Vec3 e1 = at_rest(1) - at_rest(0);
        const Vec3 e2 = at_rest(2) - at_rest(0);
        const double width = length(e1);
        const double along = dot(e1, e2) / width;
        const double height = length(cross(e1, e2)) / width;
        // Rows of the inverse of the matrix ((width, along), (0, height)).
        const std::array<double, 4> b{1.0 / width, -along / (width * height), 0.0, 1.0 / height};
        for (std::size_t k = 0; k < 4; ++k) shape[k * count + t] = static_cast<float>(b[k]);
        const double area = 0.5 * width * height;
        const Stiffness& s = stiffness[static_cast<std::size_t>(original)];
        material[t] = static_cast<float>(s.mu * area);
        material[count + t] = static_cast<float>(s.lambda * area);
    }
}

std::array<double, 2> Membranes::shape_gradient(int triangle, int corner) const {
    const auto row = [&](int k) {
        return std::array{column(shape, 2 * k, triangle), column(shape, 2 * k + 1, triangle)};
    };
    if (corner > 0) return row(corner - 1);
    return {-row(0)[0] - row(1)[0], -row(0)[1] - row(1)[1]};
}

double Membranes::energy(std::span<const float4> positions) const {
    double sum = 0.0;
    for (int t = 0; t < elements.count(); ++t) {
        sum += kernels::membrane_energy(deformed(*this, t, positions));
    }
    return sum;
}

double Membranes::stretch(int triangle, std::span<const float4> positions) const {
    const kernels::membrane m = deformed(*this, triangle, positions);
    return std::sqrt((kernels::dot3(m.u, m.u) + kernels::dot3(m.v, m.v)) / 2.0);
}

}  // namespace weft
