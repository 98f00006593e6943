#include "simulation/families/family.h"

#include <fmt/format.h>

#include <stdexcept>

#include "simulation/families/convert.h"

namespace weft {

std::unique_ptr<StencilSolve> ElementFamily::make_stencils(const VertexLayout& /*items*/,
                                                           const StencilLayout::Family&) const {
    throw std::logic_error(names_.name + " are no stencils");
}

double ElementFamily::total_energy(std::span<const float4> positions) const {
    double sum = 0.0;
    for (int e = 0; e < count(); ++e) sum += energy(e, positions_of(e, positions).data());
    return sum;
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

std::optional<BadState> ElementFamily::first_beyond(
    double most, const char* what, const std::function<double(int)>& stretch) const {
    for (int e = 0; e < count(); ++e) {
        const double ratio = stretch(e);
        if (ratio <= 1.0 + most) continue;
        return BadState{corners(e)[0], fmt::format("{} is stretched to {:g} times its size, beyond "
                                                   "guard.max_strain = {:g}",
                                                   what, ratio, most)};
    }
    return std::nullopt;
}

}  // namespace weft
