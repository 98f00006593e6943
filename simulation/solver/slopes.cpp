#include "simulation/solver/slopes.h"

namespace weft {

std::vector<Stencils> all_stencils(const Model& model) {
    std::vector<Stencils> kinds;
    if (model.springs) kinds.push_back(model.springs->elements.stencils());
    if (model.hinges) kinds.push_back(model.hinges->elements.stencils());
    return kinds;
}

Slopes::Slopes(const Model& model, VertexItems& items)
    : items_(items), sums_("slopes", 9 * static_cast<std::size_t>(items.count())) {
    if (model.springs) families_.push_back(make_spring_slopes(*model.springs, items));
    if (model.hinges) families_.push_back(make_bending_slopes(*model.hinges, items));
}

std::vector<Launch> Slopes::gather(Phase phase, Buffer<float4>& positions) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->gather({items_.segments(phase), positions, items_.vertices(),
                                           sums_, items_.count(), launches.empty() ? 1 : 0}));
    }
    return launches;
}

}  // namespace weft
