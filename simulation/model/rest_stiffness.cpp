#include "simulation/model/rest_stiffness.h"

#include <algorithm>

namespace weft {

std::array<double, kMaxCorners> rest_stiffness(const ElementFamily& family, int element,
                                               std::span<const float4> positions) {
    const auto corners = family.corners(element).size();
    const auto x = family.positions_of(element, positions);
    std::array<Mat3, kMaxCorners * kMaxCorners> blocks;
    family.hessian(element, x.data(), blocks.data());
    std::array<double, kMaxCorners> stiffness{};
    for (std::size_t k = 0; k < corners; ++k) {
        const auto& rows = blocks[k * corners + k].rows;
        stiffness[k] = std::max((rows[0].x + rows[1].y + rows[2].z) / 3.0, 0.0);
    }
    return stiffness;
}

}  // namespace weft
