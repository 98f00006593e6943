#include "simulation/families/springs/springs.h"

namespace weft {

Springs::Springs(const FamilyNames& names, const Stencils& springs, const Strips& strips,
                 std::span<const float> lengths, std::span<const float> compliances, int edges)
    : ElementFamily(names, springs, strips),
      material("springs.material", 2 * static_cast<std::size_t>(springs.count())) {
    const auto count = static_cast<std::size_t>(springs.count());
    for (std::size_t s = 0; s < count; ++s) {
        const int original = elements().original(static_cast<int>(s));
        material[s] = lengths[static_cast<std::size_t>(original)];
        material[count + s] = compliances[static_cast<std::size_t>(original)];
        if (original >= edges) attachments_.push_back(static_cast<int>(s));
    }
}

std::vector<std::string> Springs::parts() const {
    std::vector<std::string> list;
    if (std::ssize(attachments_) < count()) list.emplace_back("springs");
    if (!attachments_.empty()) list.emplace_back("attachments");
    return list;
}

std::optional<Tie> Springs::tie(int spring) const {
    if (is_edge(spring)) return std::nullopt;
    return Tie{rest_length(spring), 0.0, stiffness(spring)};
}

void Springs::add_edges(std::vector<Edge>& edges) const {
    edges.reserve(edges.size() + static_cast<std::size_t>(count()));
    for (int s = 0; s < count(); ++s) {
        if (is_edge(s)) edges.push_back({corners(s)[0], corners(s)[1], rest_length(s)});
    }
}

}  // namespace weft
