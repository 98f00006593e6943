#include "simulation/families/membranes/membranes.h"

namespace weft {

FlatTriangle laid_flat(const std::array<Vec3, 3>& corners) {
    const Vec3 e1 = corners[1] - corners[0];
    const Vec3 e2 = corners[2] - corners[0];
    const double width = length(e1);
    return {width, dot(e1, e2) / width, length(cross(e1, e2)) / width};
}

Membranes::Membranes(const FamilyNames& names, const Stencils& triangles, const Strips& strips,
                     std::span<const FlatTriangle> rest, std::span<const Stiffness> stiffness)
    : ElementFamily(names, triangles, strips),
      shape("membranes.shape", 4 * static_cast<std::size_t>(triangles.count())),
      material("membranes.material", 2 * static_cast<std::size_t>(triangles.count())) {
    const auto count = static_cast<std::size_t>(triangles.count());
    for (std::size_t t = 0; t < count; ++t) {
        const auto original = static_cast<std::size_t>(elements().original(static_cast<int>(t)));
        const auto [width, along, height] = rest[original];
        // Rows of the inverse of the matrix ((width, along), (0, height)).
        const std::array<double, 4> b{1.0 / width, -along / (width * height), 0.0, 1.0 / height};
        for (std::size_t k = 0; k < 4; ++k) shape[k * count + t] = static_cast<float>(b[k]);
        const double area = 0.5 * width * height;
        const Stiffness& s = stiffness[original];
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

void Membranes::add_edges(std::vector<Edge>& edges) const {
    for (int t = 0; t < count(); ++t) {
        const auto b1 = shape_gradient(t, 1);
        const auto b2 = shape_gradient(t, 2);
        add_edges_of(corners(t), {Vec3{b1[0], b1[1], 0}, Vec3{b2[0], b2[1], 0}, Vec3{0, 0, 1}},
                     edges);
    }
}

}  // namespace weft
