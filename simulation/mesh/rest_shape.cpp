#include "simulation/mesh/rest_shape.h"

#include <algorithm>
#include <tuple>

namespace weft {
namespace {

/// Two triangles over edges of their own, laid flat side by side: where the second one's tip is.
Vec3 laid_flat(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
    const Vec3 edge = a[1] - a[0];
    const Vec3 to_tip = a[2] - a[0];
    const Vec3 across = to_tip - (dot(to_tip, edge) / dot(edge, edge)) * edge;
    const Vec3 own_edge = b[1] - b[0];
    const Vec3 own_tip = b[2] - b[0];
    const double along = dot(own_tip, own_edge) / dot(own_edge, own_edge);
    const double height = length(cross(own_edge, own_tip)) / length(own_edge);
    return a[0] + along * edge - height * normalized(across);
}

}  // namespace

RestShape::RestShape(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t t = 0; t < mesh.rest.size(); ++t) {
        const auto& v = mesh.triangles[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(v[k], v[(k + 1) % 3]);
            sides_.push_back({low, high, v[(k + 2) % 3], t});
        }
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
}

std::span<const RestShape::Side> RestShape::sides_of(int a, int b) const {
    const auto [low, high] = std::minmax(a, b);
    const auto before = [](const Side& side, const std::pair<int, int>& edge) {
        return std::pair(side.low, side.high) < edge;
    };
    const auto after = [](const std::pair<int, int>& edge, const Side& side) {
        return edge < std::pair(side.low, side.high);
    };
    const std::pair<int, int> edge(low, high);
    const auto first = std::lower_bound(sides_.begin(), sides_.end(), edge, before);
    return {first, std::upper_bound(first, sides_.end(), edge, after)};
}

Vec3 RestShape::corner_of(std::size_t triangle, int vertex) const {
    const auto& corners = mesh_.triangles[triangle];
    const auto place = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    return mesh_.rest[triangle][static_cast<std::size_t>(place)];
}

double RestShape::length_of(int a, int b) const {
    if (sides_.empty()) return length(position(a) - position(b));
    const auto sides = sides_of(a, b);
    double sum = 0.0;
    for (const Side& side : sides) {
        sum += length(corner_of(side.triangle, a) - corner_of(side.triangle, b));
    }
    return sum / static_cast<double>(sides.size());
}

double RestShape::area_of(std::size_t triangle) const {
    const auto [a, b, c] = mesh_.rest_of(triangle);
    return 0.5 * length(cross(b - a, c - a));
}

std::array<Vec3, 4> RestShape::hinge(std::span<const int> v) const {
    if (sides_.empty()) return {position(v[0]), position(v[1]), position(v[2]), position(v[3])};
    const auto triangle = [&](int tip) {
        const auto sides = sides_of(v[0], v[1]);
        const std::size_t t = std::find_if(sides.begin(), sides.end(), [&](const Side& s) {
                                  return s.opposite == tip;
                              })->triangle;
        return std::array{corner_of(t, v[0]), corner_of(t, v[1]), corner_of(t, tip)};
    };
    const auto a = triangle(v[2]);
    const auto b = triangle(v[3]);
    const bool is_whole = a[0] == b[0] && a[1] == b[1];
    return {a[0], a[1], a[2], is_whole ? b[2] : laid_flat(a, b)};
}

}  // namespace weft
