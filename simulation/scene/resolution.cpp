#include "simulation/scene/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/scene/limits.h"

namespace weft {
namespace {

/// The resolution of a generated cloth, or null.
template <class AnyCloth>
auto resolution_of(AnyCloth& cloth) -> decltype(&std::get<GridShape>(cloth.shape).resolution) {
    if (auto* grid = std::get_if<GridShape>(&cloth.shape)) return &grid->resolution;
    if (auto* cylinder = std::get_if<CylinderShape>(&cloth.shape)) return &cylinder->resolution;
    return nullptr;
}

std::int64_t vertices_of(const Cloth& cloth) {
    const auto* resolution = resolution_of(cloth);
    return resolution ? std::int64_t{(*resolution)[0]} * (*resolution)[1] : 0;
}

std::int64_t vertices_of(const std::vector<Cloth>& cloths) {
    std::int64_t sum = 0;
    for (const Cloth& cloth : cloths) sum += vertices_of(cloth);
    return sum;
}

int scaled(int resolution, double factor) {
    // 3 around a cylinder is the least; a grid can spare the difference to 2.
    return std::max(3, static_cast<int>(std::lround(resolution * factor)));
}

}  // namespace

void scale_resolutions(std::vector<Cloth>& cloths, int vertices) {
    const std::int64_t now = vertices_of(cloths);
    if (now == 0) return;
    const double factor = std::sqrt(static_cast<double>(vertices) / static_cast<double>(now));
    for (Cloth& cloth : cloths) {
        if (auto* resolution = resolution_of(cloth)) {
            for (int& count : *resolution) count = scaled(count, factor);
        }
    }
}

void check_vertex_count(const Scene& scene) {
    const std::int64_t vertices = vertices_of(scene.cloths);
    if (vertices <= kMaxVertices) return;
    throw UserError(
        fmt::format("{}: the grids and cylinders have {} vertices, more than the {} "
                    "that indices can count; lower a cloth's resolution or scene.size",
                    scene.path, vertices, kMaxVertices));
}

}  // namespace weft
