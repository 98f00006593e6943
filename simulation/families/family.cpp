#include "simulation/families/family.h"

#include <stdexcept>

#include "runtime/tbb/parallel.h"
#include "simulation/families/convert.h"

namespace weft {

std::unique_ptr<StencilSolve> ElementFamily::make_stencils(const VertexLayout& /*items*/,
                                                           const StencilLayout::Family&) const {
    throw std::logic_error(names_.name + " are no stencils");
}

double ElementFamily::total_energy(std::span<const float4> positions) const {
    return sum_of_blocks(count(),
                         [&](int begin, int end) { return sum_energies(begin, end, positions); });
}

std::array<Vec3, kMaxCorners> ElementFamily::positions_of(int element,
                                                          std::span<const float4> positions) const {
    std::array<Vec3, kMaxCorners> x;
    const auto vertices = corners(element);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        x[k] = to_vec3(positions[static_cast<std::size_t>(vertices[k])]);
    }
    return x;
}

void ElementFamily::add_edges_of(std::span<const int> corners, const std::array<Vec3, 3>& b,
                                 std::vector<Edge>& edges) {
    const double determinant = dot(b[0], cross(b[1], b[2]));
    std::array<Vec3, kMaxCorners> x{};  // at rest
    for (std::size_t k = 0; k < 3; ++k) {
        x[k + 1] = (1.0 / determinant) * cross(b[(k + 1) % 3], b[(k + 2) % 3]);
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t j = i + 1; j < corners.size(); ++j) {
            edges.push_back({corners[i], corners[j], length(x[j] - x[i])});
        }
    }
}

}  // namespace weft
