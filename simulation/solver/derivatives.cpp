#include "simulation/solver/derivatives.h"

#include "runtime/tbb/parallel.h"

namespace weft {

VertexDerivatives::VertexDerivatives(Model& model, VertexItems& items)
    : items_(items),
      sums_("derivatives", 9 * static_cast<std::size_t>(items.count())),
      families_(model.families.size()) {
    for_each_apart(static_cast<int>(families_.size()), [&](int f) {
        const auto i = static_cast<std::size_t>(f);
        families_[i] = model.families[i]->make_rows(items);
    });
}

std::vector<Launch> VertexDerivatives::gather(Phase phase, Buffer<float4>& positions) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->gather(target(phase, positions, launches.empty())));
    }
    return launches;
}

std::vector<Launch> VertexDerivatives::gather_gradients(Phase phase, Buffer<float4>& positions) {
    std::vector<Launch> launches;
    for (const auto& family : families_) {
        launches.push_back(family->gather_gradients(target(phase, positions, launches.empty())));
    }
    return launches;
}

DerivativeTarget VertexDerivatives::target(Phase phase, Buffer<float4>& positions, bool is_first) {
    return {items_.segments(phase), positions,       items_.vertices(), sums_,
            items_.count(),         is_first ? 1 : 0};
}

void VertexDerivatives::add_hessian_accesses(Step::Adding& task, int first, int last, bool writes) {
    for (int column = 3; column < 9; ++column) {
        const int begin = column * items_.count();
        if (writes)
            task.updates(sums_, begin + first, begin + last);
        else
            task.reads(sums_, begin + first, begin + last);
    }
}

}  // namespace weft
