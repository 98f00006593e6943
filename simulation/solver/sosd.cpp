#include "simulation/solver/sosd.h"

#include <algorithm>
#include <functional>

#include "kernels/sosd/single_vertices.h"
#include "simulation/families/stencil_tables.h"
#include "simulation/solver/sweeps.h"

namespace weft {

namespace {

constexpr int kBlocks = 3;  ///< sweeps until the first main block comes again

/// All elements, those of one colour first, then those of the next, and so on in turn.
StencilCandidates from_colour(const Elements& elements, int colour) {
    StencilCandidates candidates{elements.stencils(), {}};
    for (const Phase phase : {kSeamPhase, kInnerPhase}) {
        const Segments& segments = elements.segments(phase);
        for (int c = 0; c < segments.colour_count; ++c) {
            const int now = (c + colour) % segments.colour_count;
            for (int strip = 0; strip < segments.strip_count; ++strip) {
                for (int e = segments.item(strip, now); e < segments.item(strip, now + 1); ++e) {
                    candidates.order.push_back(e);
                }
            }
        }
    }
    return candidates;
}

/// Vertices that belong to no stencil.
class SingleVertices final : public StencilSolve {
public:
    SingleVertices(const VertexLayout& items, const StencilLayout::Family& chosen)
        : tables_(items, chosen) {}
    Launch solve(const SweepTarget& t) override {
        return tables_.launch_over(kernels::solve_single_vertices, t);
    }

private:
    StencilTables tables_;
};

/// The families whose elements may be stencils; those with the most vertices come first.
std::vector<const ElementFamily*> stencil_families(const Model& model) {
    std::vector<const ElementFamily*> families;
    for (const auto& family : model.families) {
        if (family->has_stencils()) families.push_back(family.get());
    }
    std::ranges::stable_sort(families, std::greater{}, [](const ElementFamily* family) {
        return family->elements().arity();
    });
    return families;
}

class SosdSolver final : public SweepSolver {
public:
    explicit SosdSolver(Model& model) : SweepSolver(model) {
        const auto kinds = model.stencils();
        for (int b = 0; b < kBlocks; ++b) add_block(model, kinds, b);
    }

private:
    void add_block(const Model& model, std::span<const Stencils> kinds, int colour) {
        const auto families = stencil_families(model);
        std::vector<StencilCandidates> candidates;
        for (const ElementFamily* family : families) {
            candidates.push_back(from_colour(family->elements(), colour));
        }
        const StencilLayout layout = make_stencil_layout(kinds, model.strips, candidates);

        std::vector<StencilSolve*> block;
        const auto add = [&](std::unique_ptr<StencilSolve> solve) {
            block.push_back(solves_.emplace_back(std::move(solve)).get());
        };
        for (std::size_t f = 0; f < families.size(); ++f) {
            const StencilLayout::Family& chosen = layout.families[f];
            if (chosen.elements.empty()) continue;
            add(families[f]->make_stencils(layout.items, chosen));
        }
        const StencilLayout::Family& single = layout.families.back();
        if (!single.elements.empty()) add(std::make_unique<SingleVertices>(layout.items, single));
        add_sweep(layout.items, [&](const SweepTarget& t) {
            std::vector<Launch> launches;
            for (StencilSolve* solve : block) launches.push_back(solve->solve(t));
            return launches;
        });
    }

    std::vector<std::unique_ptr<StencilSolve>> solves_;
};

}  // namespace

std::unique_ptr<Solver> make_sosd_solver(Model& model) {
    return std::make_unique<SosdSolver>(model);
}

}  // namespace weft
