#pragma once

#include "kernels/newton/hinges.h"
#include "runtime/tbb/parallel.h"
#include "simulation/families/family.h"

namespace weft {

/// Blocks of elements whose Hessian is q q^T in each dimension, with constant weights q: summed
/// here, once. Family says weight(element, corner).
template <class Family>
class ConstantBlocks final : public BlockRows {
public:
    ConstantBlocks(const Family& family, const BlockList& list)
        : weights_(family.names().name + ".block_weights", static_cast<std::size_t>(list.count())) {
        for_each_block(list.count(), [&](int /*number*/, int begin, int end) {
            for (int block = begin; block < end; ++block) {
                double sum = 0.0;
                for (const Coupling& c : list[block]) {
                    sum -= family.weight(c.element, c.j) * family.weight(c.element, c.k);
                }
                weights_[static_cast<std::size_t>(block)] = static_cast<float>(sum);
            }
        });
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_hinges, t.segments, weights_, t.blocks, t.block_count,
                       t.columns, t.fresh)};
    }
    Buffer<float>* constant_blocks() override { return &weights_; }

private:
    Buffer<float> weights_;
};

}  // namespace weft
