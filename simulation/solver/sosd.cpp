#include "simulation/solver/sosd.h"

#include <algorithm>
#include <type_traits>

#include "kernels/sosd/alone.h"
#include "kernels/sosd/membranes.h"
#include "kernels/sosd/springs.h"
#include "kernels/sosd/tetrahedra.h"
#include "simulation/solver/sweeps.h"
#include "simulation/topology/stencil_layout.h"

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

/// The stencils of one family in one sweep.
class StencilFamily {
public:
    StencilFamily(const VertexLayout& items, const StencilLayout::Family& family)
        : corners_("stencils.corners",
                   static_cast<std::size_t>(family.arity) * family.corners.size()),
          segment_begin_("stencils.segments", family.segment_begin.size()),
          count_(static_cast<int>(family.corners.size())) {
        for (std::size_t i = 0; i < corners_.count(); ++i) {
            corners_[i] = family.corners[i % family.corners.size()][i / family.corners.size()];
        }
        std::copy(family.segment_begin.begin(), family.segment_begin.end(), segment_begin_.data());
        for (const Phase phase : {kSeamPhase, kInnerPhase}) {
            segments_[phase] = {&segment_begin_, items.segment(phase, 0, 0),
                                items.colour_count[phase], items.strip_count};
        }
    }
    virtual ~StencilFamily() = default;

    virtual Launch solve(const SweepTarget& t) = 0;

protected:
    /// `tables` are those of the family's elements, if it has any.
    template <class Kernel, class... Tables>
    Launch launch_over_stencils(Kernel kernel, const SweepTarget& t, Tables&... tables) {
        return launch(kernel, segments_[t.phase], t.positions, t.targets, t.items.vertices(),
                      corners_, tables..., t.sums, count_, t.items.count(), t.inverse_h2);
    }

private:
    Buffer<int> corners_;  ///< [arity * count] column-major: items
    Buffer<int> segment_begin_;
    std::array<Segments, kPhaseCount> segments_;
    int count_;
};

/// The rows of a column-major table that belong to these elements.
void copy_rows(const Buffer<float>& table, int row_count, const std::vector<int>& elements,
               Buffer<float>& picked) {
    for (std::size_t i = 0; i < picked.count(); ++i) {
        const std::size_t column = i / elements.size() * static_cast<std::size_t>(row_count);
        picked[i] = table[column + static_cast<std::size_t>(elements[i % elements.size()])];
    }
}

class LoneVertices final : public StencilFamily {
public:
    using StencilFamily::StencilFamily;
    Launch solve(const SweepTarget& t) override {
        return launch_over_stencils(kernels::solve_lone_vertices, t);
    }
};

class SpringStencils final : public StencilFamily {
public:
    SpringStencils(const VertexLayout& items, const StencilLayout::Family& family,
                   const Springs& springs)
        : StencilFamily(items, family), material_("stencils.material", 2 * family.elements.size()) {
        const std::size_t count = family.elements.size();
        for (std::size_t i = 0; i < count; ++i) {
            material_[i] = static_cast<float>(springs.rest_length(family.elements[i]));
            material_[count + i] = static_cast<float>(springs.stiffness(family.elements[i]));
        }
    }
    Launch solve(const SweepTarget& t) override {
        return launch_over_stencils(kernels::solve_spring_stencils, t, material_);
    }

private:
    Buffer<float> material_;
};

/// Tetrahedra or membranes.
template <class Kind, class Kernel>
class ElasticStencils final : public StencilFamily {
public:
    ElasticStencils(const VertexLayout& items, const StencilLayout::Family& family,
                    const Kind& kind)
        : StencilFamily(items, family),
          shape_("stencils.shape", columns(kind, kind.shape) * family.elements.size()),
          material_("stencils.material", columns(kind, kind.material) * family.elements.size()) {
        copy_rows(kind.shape, kind.elements.count(), family.elements, shape_);
        copy_rows(kind.material, kind.elements.count(), family.elements, material_);
    }
    Launch solve(const SweepTarget& t) override {
        return launch_over_stencils(Kernel{}, t, shape_, material_);
    }

private:
    static std::size_t columns(const Kind& kind, const Buffer<float>& table) {
        return table.count() / static_cast<std::size_t>(kind.elements.count());
    }
    Buffer<float> shape_;
    Buffer<float> material_;
};

using TetrahedronStencils = ElasticStencils<Tetrahedra, kernels::solve_tetrahedron_stencils_kernel>;
using MembraneStencils = ElasticStencils<Membranes, kernels::solve_membrane_stencils_kernel>;

class SosdSolver final : public SweepSolver {
public:
    explicit SosdSolver(Model& model) : SweepSolver(model) {
        const auto kinds = all_stencils(model);
        for (int b = 0; b < kBlocks; ++b) add_block(model, kinds, b);
    }

private:
    /// The elements with the most vertices come first.
    void add_block(const Model& model, std::span<const Stencils> kinds, int colour) {
        std::vector<StencilCandidates> candidates;
        if (model.tetrahedra) candidates.push_back(from_colour(model.tetrahedra->elements, colour));
        if (model.membranes) candidates.push_back(from_colour(model.membranes->elements, colour));
        if (model.springs) candidates.push_back(from_colour(model.springs->elements, colour));
        const StencilLayout layout = make_stencil_layout(kinds, model.strips, candidates);

        std::vector<StencilFamily*> block;
        auto next = layout.families.begin();
        const auto add = [&]<class Family>(std::type_identity<Family>, const auto&... kind) {
            const StencilLayout::Family& family = *next++;
            if (family.elements.empty()) return;
            block.push_back(
                families_.emplace_back(std::make_unique<Family>(layout.items, family, kind...))
                    .get());
        };
        if (model.tetrahedra) add(std::type_identity<TetrahedronStencils>{}, *model.tetrahedra);
        if (model.membranes) add(std::type_identity<MembraneStencils>{}, *model.membranes);
        if (model.springs) add(std::type_identity<SpringStencils>{}, *model.springs);
        add(std::type_identity<LoneVertices>{});
        add_sweep(layout.items, [&](const SweepTarget& t) {
            std::vector<Launch> launches;
            for (StencilFamily* family : block) launches.push_back(family->solve(t));
            return launches;
        });
    }

    std::vector<std::unique_ptr<StencilFamily>> families_;
};

}  // namespace

std::unique_ptr<Solver> make_sosd_solver(Model& model) {
    return std::make_unique<SosdSolver>(model);
}

}  // namespace weft
