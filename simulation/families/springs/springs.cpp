#include "simulation/families/springs/springs.h"

#include <fmt/format.h>

#include "simulation/families/convert.h"

namespace weft {

Springs::Springs(const FamilyNames& names, const Stencils& springs, const Strips& strips,
                 std::span<const double> lengths, std::span<const double> stiffness, int edges)
    : ElementFamily(names, springs, strips),
      material("springs.material", 2 * static_cast<std::size_t>(springs.count())),
      edge_count_(edges) {
    const auto count = static_cast<std::size_t>(springs.count());
    for (std::size_t s = 0; s < count; ++s) {
        const auto original = static_cast<std::size_t>(elements().original(static_cast<int>(s)));
        material[s] = static_cast<float>(lengths[original]);
        material[count + s] = static_cast<float>(1.0 / stiffness[original]);
    }
}

std::vector<std::string> Springs::parts() const {
    std::vector<std::string> list;
    if (edge_count_ > 0) list.emplace_back("springs");
    if (edge_count_ < count()) list.emplace_back("attachments");
    return list;
}

std::optional<BadState> Springs::find_overstretched(std::span<const float4> positions,
                                                    double most) const {
    for (int s = 0; s < count(); ++s) {
        if (!is_edge(s)) continue;
        const auto ends = corners(s);
        const Vec3 along = to_vec3(positions[static_cast<std::size_t>(ends[0])]) -
                           to_vec3(positions[static_cast<std::size_t>(ends[1])]);
        const double limit = rest_length(s) * (1.0 + most);
        if (dot(along, along) <= limit * limit) continue;
        return BadState{ends[0], fmt::format("edge of {:g} m is stretched to {:g} m, beyond "
                                             "guard.max_strain = {:g}",
                                             rest_length(s), length(along), most)};
    }
    return std::nullopt;
}

}  // namespace weft
