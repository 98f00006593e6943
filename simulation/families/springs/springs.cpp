#include "simulation/families/springs/springs.h"

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

void Springs::add_edges(std::vector<Edge>& edges) const {
    for (int s = 0; s < count(); ++s) {
        if (is_edge(s)) edges.push_back({corners(s)[0], corners(s)[1], rest_length(s)});
    }
}

}  // namespace weft
