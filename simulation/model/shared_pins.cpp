#include "simulation/model/shared_pins.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace weft {

void SharedPins::add(int vertex, const PinGroup& pins) {
    const PinGroup*& holder = holder_[static_cast<std::size_t>(vertex)];
    if (holder == nullptr) holder = &pins;
    if (holder->motion != pins.motion) shared_.push_back(vertex);
}

void SharedPins::warn(const std::string& body, Warnings& warnings) const {
    constexpr std::size_t kNamed = 3;
    if (shared_.empty()) return;
    const std::set<int> vertices(shared_.begin(), shared_.end());
    std::vector<int> named(vertices.begin(), vertices.end());
    named.resize(std::min(named.size(), kNamed));
    warnings.push_back(fmt::format(
        "{} of the vertices of {} are held by several pins that move differently (the first: {}): "
        "each follows the last of these that has a motion, and no other",
        vertices.size(), body, fmt::join(named, ", ")));
}

}  // namespace weft
