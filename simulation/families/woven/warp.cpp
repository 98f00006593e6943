#include "simulation/families/woven/warp.h"

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/selection.h"

namespace weft {

namespace {

constexpr double kLeastSine = 1e-3;  ///< of the angle between a vector and a triangle's normal

/// A direction of the cloth's own frame in the world.
Vec3 placed(Vec3 direction, const Transform& transform) {
    std::array<Vec3, 2> ends{Vec3{}, direction};
    place(ends, transform);
    return ends[1] - ends[0];
}

/// What the shape says by itself.
std::optional<Vec3> direction_of(const Cloth& cloth) {
    if (std::holds_alternative<GridShape>(cloth.shape)) return placed({1, 0, 0}, cloth.transform);
    if (std::holds_alternative<CylinderShape>(cloth.shape)) {
        return placed({0, -1, 0}, cloth.transform);
    }
    return std::nullopt;
}

/// The vector in the plane of two edges, by these.
WarpDirection laid_into(Vec3 e1, Vec3 e2, Vec3 v) {
    const double a = dot(e1, e1);
    const double b = dot(e1, e2);
    const double c = dot(e2, e2);
    const double determinant = a * c - b * b;
    const double p = dot(v, e1);
    const double q = dot(v, e2);
    return {(c * p - b * q) / determinant, (a * q - b * p) / determinant};
}

UserError error_at(const Cloth& cloth, std::size_t triangle, const std::string& what) {
    return UserError(fmt::format("{}: woven cloth '{}', triangle {} (counted from 1): {}",
                                 cloth.where, cloth.name, triangle + 1, what));
}

WarpDirection along_vector(const Cloth& cloth, const TriangleMesh& mesh, std::size_t t, Vec3 v) {
    const auto at = [&](std::size_t k) {
        return mesh.positions[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const Vec3 e1 = at(1) - at(0);
    const Vec3 e2 = at(2) - at(0);
    const WarpDirection warp = laid_into(e1, e2, v);
    if (length(warp[0] * e1 + warp[1] * e2) > kLeastSine * length(v)) return warp;
    throw error_at(cloth, t,
                   "the warp's direction is perpendicular to it; choose another "
                   "woven.direction, or give the mesh texture coordinates");
}

/// dX/du, where the texture coordinates are (u, v).
WarpDirection along_texture(const Cloth& cloth, const TriangleMesh& mesh, std::size_t t) {
    const auto& uv = mesh.texture[t];
    const double u1 = uv[1][0] - uv[0][0];
    const double v1 = uv[1][1] - uv[0][1];
    const double u2 = uv[2][0] - uv[0][0];
    const double v2 = uv[2][1] - uv[0][1];
    const double area = u1 * v2 - u2 * v1;
    if (area == 0.0) {
        throw error_at(cloth, t, "its texture coordinates have no area; set woven.direction");
    }
    return {v2 / area, -v1 / area};
}

}  // namespace

std::vector<WarpDirection> warp_directions(const Cloth& cloth, const Woven& woven,
                                           const TriangleMesh& mesh) {
    const std::optional<Vec3> vector = woven.direction ? woven.direction : direction_of(cloth);
    if (!vector && mesh.texture.empty()) {
        throw UserError(
            fmt::format("{}: woven cloth '{}': {} has no texture coordinates to say where the "
                        "warp runs; set woven.direction = [x, y, z]",
                        cloth.where, cloth.name, mesh.source));
    }
    std::vector<WarpDirection> warp;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        warp.push_back(vector ? along_vector(cloth, mesh, t, *vector)
                              : along_texture(cloth, mesh, t));
    }
    return warp;
}

}  // namespace weft
