#include "kernels/newton/hinges.h"
#include "simulation/families/hinges/hinges.h"

namespace weft {

namespace {

/// Constant, so summed here.
class HingeBlocks final : public BlockRows {
public:
    HingeBlocks(const Hinges& hinges, const BlockList& list)
        : weights_("hinges.block_weights", static_cast<std::size_t>(list.count())) {
        for (int block = 0; block < list.count(); ++block) {
            double sum = 0.0;
            for (const Coupling& c : list[block]) {
                sum -= hinges.weight(c.element, c.j) * hinges.weight(c.element, c.k);
            }
            weights_[static_cast<std::size_t>(block)] = static_cast<float>(sum);
        }
    }

    std::vector<Launch> couple(const BlockTarget& t) override {
        return {launch(kernels::couple_hinges, t.segments, weights_, t.blocks, t.block_count,
                       t.columns, t.fresh)};
    }

private:
    Buffer<float> weights_;
};

}  // namespace

std::unique_ptr<BlockRows> Hinges::make_block_rows(const BlockList& list) {
    return std::make_unique<HingeBlocks>(*this, list);
}

}  // namespace weft
