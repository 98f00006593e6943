#include "simulation/solver/slopes.h"

namespace weft {

std::vector<Stencils> all_stencils(const Model& model) {
    std::vector<Stencils> kinds;
    if (model.springs) kinds.push_back(model.springs->elements.stencils());
    if (model.membranes) kinds.push_back(model.membranes->elements.stencils());
    if (model.tetrahedra) kinds.push_back(model.tetrahedra->elements.stencils());
    if (model.hinges) kinds.push_back(model.hinges->elements.stencils());
    return kinds;
}

Slopes::Slopes(const Model& model, VertexItems& items)
    : items_(items), sums_("slopes", 9 * static_cast<std::size_t>(items.count())) {
    if (model.springs) families_.push_back(make_spring_slopes(*model.springs, items));
    if (model.membranes) families_.push_back(make_membrane_slopes(*model.membranes, items));
    if (model.tetrahedra) families_.push_back(make_tetrahedron_slopes(*model.tetrahedra, items));
    if (model.hinges) families_.push_back(make_bending_slopes(*model.hinges, items));
}

std::vector<Launch> Slopes::gather(Phase phase, Buffer<float4>& positions) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->gather(target(phase, positions, launches.empty())));
    }
    return launches;
}

std::vector<Launch> Slopes::gather_forces(Phase phase, Buffer<float4>& positions) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->gather_forces(target(phase, positions, launches.empty())));
    }
    return launches;
}

SlopeTarget Slopes::target(Phase phase, Buffer<float4>& positions, bool is_first) {
    return {items_.segments(phase), positions,       items_.vertices(), sums_,
            items_.count(),         is_first ? 1 : 0};
}

void Slopes::add_hessian_accesses(Step::Adding& task, int first, int last, bool writes) {
    for (int column = 3; column < 9; ++column) {
        const int begin = column * items_.count();
        if (writes)
            task.updates(sums_, begin + first, begin + last);
        else
            task.reads(sums_, begin + first, begin + last);
    }
}

}  // namespace weft
