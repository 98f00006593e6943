#include "simulation/scene/resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/generators.h"
#include "simulation/scene/limits.h"

namespace weft {
namespace {

/// A resolution of a generated shape.
struct Count {
    int* value;
    int least = 3;  ///< around a cylinder; a grid can spare the difference to 2
};

/// None of a file.
std::vector<Count> resolutions_of(Shape& shape) {
    const auto pointers = [](auto& resolution) {
        std::vector<Count> list;
        for (int& count : resolution) list.push_back({&count});
        return list;
    };
    if (auto* grid = std::get_if<GridShape>(&shape)) return pointers(grid->resolution);
    if (auto* cylinder = std::get_if<CylinderShape>(&shape)) return pointers(cylinder->resolution);
    auto* block = std::get_if<BlockShape>(&shape);
    if (block == nullptr) return {};
    std::vector<Count> list = pointers(block->resolution);
    for (std::size_t k = 0; k < 2; ++k) {
        list[k].least = std::max(list[k].least, least_resolution(*block)[k]);
    }
    return list;
}

void scale(Shape& shape, double factor) {
    for (const Count& count : resolutions_of(shape)) {
        *count.value = std::max(count.least, static_cast<int>(std::lround(*count.value * factor)));
    }
}

/// Vertices of a generated shape if its resolutions were scaled.
double vertices_of(Shape shape, double factor) {
    if (factor != 1.0) scale(shape, factor);
    const auto* block = std::get_if<BlockShape>(&shape);
    if (block != nullptr && !block->outline.empty()) {
        return outlined_vertex_count(block->resolution, block->outline);
    }
    const std::vector<Count> resolutions = resolutions_of(shape);
    double product = resolutions.empty() ? 0.0 : 1.0;
    for (const Count& count : resolutions) product *= *count.value;
    return product;
}

double vertices_of(const Scene& scene, double factor) {
    double sum = 0.0;
    for (const Cloth& cloth : scene.cloths) sum += vertices_of(cloth.shape, factor);
    for (const Solid& solid : scene.solids) sum += vertices_of(solid.shape, factor);
    return sum;
}

}  // namespace

bool scale_resolutions(Scene& scene, int vertices) {
    if (vertices_of(scene, 1.0) == 0.0) return false;
    // Cloths grow with the factor's square and solids with its cube: so by halving intervals.
    double low = 0.0;
    double high = 1.0;
    while (vertices_of(scene, high) < vertices) high *= 2.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (vertices_of(scene, middle) < vertices ? low : high) = middle;
    }
    const bool low_is_nearer =
        vertices - vertices_of(scene, low) < vertices_of(scene, high) - vertices;
    const double factor = low_is_nearer ? low : high;
    for (Cloth& cloth : scene.cloths) scale(cloth.shape, factor);
    for (Solid& solid : scene.solids) scale(solid.shape, factor);
    return true;
}

std::array<int, 2> least_resolution(const BlockShape& block) {
    if (block.outline.empty()) return {2, 2};
    return {static_cast<int>(block.outline.front().size()) + 1,
            static_cast<int>(block.outline.size()) + 1};
}

void check_vertex_count(const Scene& scene) {
    const double vertices = vertices_of(scene, 1.0);
    if (vertices <= static_cast<double>(kMaxVertices)) return;
    throw UserError(
        fmt::format("{}: the grids and cylinders have {:.0f} vertices, more than the {} "
                    "that indices can count; lower a resolution or scene.size",
                    scene.path, vertices, kMaxVertices));
}

}  // namespace weft
