#include "simulation/solver/sosd.h"

#include "kernels/sosd/solve.h"
#include "simulation/solver/sweeps.h"

namespace weft {

namespace {

constexpr int kBlocks = 3;  ///< sweeps until the first main block comes again

/// All springs, those of one colour first, then those of the next, and so on in turn.
std::vector<int> springs_from_colour(const Elements& springs, int colour) {
    std::vector<int> order;
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        const Segments& segments = springs.segments(phase);
        for (int c = 0; c < segments.colour_count; ++c) {
            const int now = (c + colour) % segments.colour_count;
            for (int strip = 0; strip < segments.strip_count; ++strip) {
                for (int s = segments.item(strip, now); s < segments.item(strip, now + 1); ++s) {
                    order.push_back(s);
                }
            }
        }
    }
    return order;
}

/// Without springs, all vertices are alone.
StencilLayout make_layout(const Model& model, std::span<const Stencils> kinds, int block) {
    if (!model.springs) return make_stencil_layout(kinds, model.strips, Stencils{}, {});
    const Elements& springs = model.springs->elements;
    return make_stencil_layout(kinds, model.strips, springs.stencils(),
                               springs_from_colour(springs, block));
}

/// The tables of one sweep's stencils.
struct Block {
    Block(const Model& model, const StencilLayout& layout)
        : corners("stencils.corners", 2 * layout.stencils.size()),
          material("stencils.material", 2 * layout.stencils.size()),
          segment_begin("stencils.segments", layout.segment_begin.size()) {
        const std::size_t count = layout.stencils.size();
        for (std::size_t i = 0; i < count; ++i) {
            corners[i] = layout.corners[i][0];
            corners[count + i] = layout.corners[i][1];
            const int spring = layout.stencils[i];
            if (spring < 0) continue;
            material[i] = static_cast<float>(model.springs->rest_length(spring));
            material[count + i] = static_cast<float>(model.springs->stiffness(spring));
        }
        std::copy(layout.segment_begin.begin(), layout.segment_begin.end(), segment_begin.data());
        for (const Phase phase : {kSeamPhase, kInnerPhase}) {
            const VertexLayout& items = layout.items;
            segments[phase] = {&segment_begin, items.segment(phase, 0, 0),
                               items.colour_count[phase], items.strip_count};
        }
    }
    int count() const { return static_cast<int>(corners.count() / 2); }

    Buffer<int> corners;
    Buffer<float> material;
    Buffer<int> segment_begin;
    std::array<Segments, kPhaseCount> segments;
};

class SosdSolver final : public SweepSolver {
public:
    explicit SosdSolver(Model& model) : SweepSolver(model) {
        const auto kinds = all_stencils(model);
        for (int b = 0; b < kBlocks; ++b) {
            const StencilLayout layout = make_layout(model, kinds, b);
            Block& block = *blocks_.emplace_back(std::make_unique<Block>(model, layout));
            add_sweep(layout.items, [&](const Gathered& g) {
                return launch(kernels::solve_stencils, block.segments[g.phase], *model.positions,
                              g.targets, g.items.vertices(), block.corners, block.material, g.sums,
                              block.count(), g.items.count(), g.inverse_h2);
            });
        }
    }

private:
    std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace

std::unique_ptr<Solver> make_sosd_solver(Model& model) {
    return std::make_unique<SosdSolver>(model);
}

}  // namespace weft
