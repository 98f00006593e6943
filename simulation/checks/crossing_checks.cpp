#include "simulation/checks/crossing_checks.h"

#include <bit>

namespace weft {

namespace {

constexpr std::size_t kNamedPairs = 3;
constexpr unsigned kFirst = 8;  ///< frames; a look takes the time of some substeps

}  // namespace

CrossingChecks::CrossingChecks(const Model& model, bool may_cross) : surface_(model) {
    if (!may_cross) return;
    for (const TrianglePair& pair : surface_.crossings(surface_.surface().tree())) {
        known_.insert(bodies(pair));
    }
}

bool CrossingChecks::wants(const Model& model, int frame) const {
    const unsigned frames = static_cast<unsigned>(frame) + 1U;
    const bool is_due = frames >= kFirst && std::has_single_bit(frames);
    return !is_told_ && (is_due || frame == model.scene.frames - 1);
}

std::string CrossingChecks::look(const Model& model) {
    surface_.move(model);
    std::vector<TrianglePair> pairs = surface_.crossings(surface_.surface().tree());
    std::erase_if(pairs, [&](const TrianglePair& pair) { return known_.contains(bodies(pair)); });
    if (pairs.empty()) return {};
    is_told_ = true;
    return text_of_crossings(model, pairs, kNamedPairs);
}

std::array<int, 2> CrossingChecks::bodies(const TrianglePair& pair) const {
    return {surface_.body(pair[0]), surface_.body(pair[1])};
}

}  // namespace weft
