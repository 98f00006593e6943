#include "simulation/families/woven/woven.h"

namespace weft {

WovenCloth::WovenCloth(const FamilyNames& names, const Stencils& triangles, const Strips& strips,
                       std::span<const std::array<Vec3, 2>> edges,
                       std::span<const WarpDirection> warp,
                       std::span<const WovenStiffness> stiffness)
    : ElementFamily(names, triangles, strips),
      shape("woven.shape", 4 * static_cast<std::size_t>(triangles.count())),
      material("woven.material", 3 * static_cast<std::size_t>(triangles.count())) {
    const auto count = static_cast<std::size_t>(triangles.count());
    for (std::size_t t = 0; t < count; ++t) {
        const auto original = static_cast<std::size_t>(elements().original(static_cast<int>(t)));
        const auto& [e1, e2] = edges[original];
        const Vec3 along = normalized(warp[original][0] * e1 + warp[original][1] * e2);
        const Vec3 across = cross(normalized(cross(e1, e2)), along);
        const double u1 = dot(e1, along);
        const double v1 = dot(e1, across);
        const double u2 = dot(e2, along);
        const double v2 = dot(e2, across);
        const double twice_area = u1 * v2 - u2 * v1;
        // Rows of the inverse of the matrix ((u1, u2), (v1, v2)).
        const std::array<double, 4> b{v2 / twice_area, -u2 / twice_area, -v1 / twice_area,
                                      u1 / twice_area};
        for (std::size_t k = 0; k < b.size(); ++k) shape[k * count + t] = static_cast<float>(b[k]);
        for (std::size_t k = 0; k < 3; ++k) {
            material[k * count + t] = static_cast<float>(0.5 * twice_area * stiffness[original][k]);
        }
    }
}

std::array<double, 2> WovenCloth::shape_gradient(int triangle, int corner) const {
    const auto row = [&](int k) {
        return std::array{column(shape, 2 * k, triangle), column(shape, 2 * k + 1, triangle)};
    };
    if (corner > 0) return row(corner - 1);
    return {-row(0)[0] - row(1)[0], -row(0)[1] - row(1)[1]};
}

void WovenCloth::add_edges(std::vector<Edge>& edges) const {
    for (int t = 0; t < count(); ++t) {
        const auto b1 = shape_gradient(t, 1);
        const auto b2 = shape_gradient(t, 2);
        add_edges_of(corners(t), {Vec3{b1[0], b1[1], 0}, Vec3{b2[0], b2[1], 0}, Vec3{0, 0, 1}},
                     edges);
    }
}

}  // namespace weft
