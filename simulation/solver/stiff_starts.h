#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/solver/halo.h"
#include "simulation/solver/held_bodies.h"

namespace weft {

/// Where substeps of stiff bodies start: from x~, or from the shape that they had, moved as a whole
/// (kernels/bodies/starts.h). Of bodies that obstacles or others may touch, this is for those that
/// are moved as wholes at the end, too, which know what has touched them; else for all. Tasks
/// between the beginning of a substep and its first iteration.
class StiffStarts {
public:
    /// What the solver has.
    struct Setting {
        Buffer<float4>& targets;  ///< [vertices] x~
        VertexItems& items;
        VertexDerivatives& derivatives;  ///< of these; their gradients are overwritten
        std::vector<Phase> phases;       ///< that have items
        bool keeps_blocks;               ///< whether their Hessian blocks outlive tasks
        const Halo& halo;
        ContactResponse* contact;  ///< null: none
        bool solves_all;           ///< all of a step at once, as newton does
    };
    /// Null: no body is so stiff. held: null: none; must outlive this
    static std::unique_ptr<StiffStarts> of(Model& model, HeldBodies* held, const Setting& setting,
                                           int first_kind);

    static std::vector<std::string> kinds();
    std::vector<const TaskBody*> bodies() const;
    void add(Step& step, const std::vector<Region>& regions);
    /// See Solver::state(); null: none.
    BufferStorage* state() { return touched_; }

private:
    enum Kind { kSums, kMotions, kRises, kTotals, kStarts };

    /// needs_others: than those that `held` moves. margins: [bodies]
    StiffStarts(Model& model, HeldBodies* held, bool needs_others,
                const std::vector<HeldBody>& bodies, const std::vector<float>& margins,
                const Setting& setting, int first_kind);
    void make_bodies(int first_kind);
    std::vector<Launch> weigh(Phase phase);
    HeldSums::Place place();
    /// Of the regions with such bodies.
    void add_sums(Step& step, const Region& region);
    void add_motions(Step& step, const Region& region);
    void add_rises(Step& step, const Region& region);
    void add_rises(Step& step, const TaskBody& body, StripRange strips, RegionId region, int first,
                   int last);
    void add_totals(Step& step, const Region& region);
    void add_starts(Step& step, const Region& region);

    Model& model_;
    std::unique_ptr<HeldSums> own_sums_;  ///< null: those of held bodies
    HeldSums& held_sums_;
    Setting setting_;
    Buffer<float> margins_;  ///< [runs] see the kernels
    Buffer<float>* touched_;
    Buffer<int> bounds_;      ///< [2 * runs]
    Buffer<float4> carries_;  ///< [runs + 1] see the kernels for these and the following
    Buffer<float> rises_;     ///< [vertices]
    Buffer<float4> totals_;   ///< [runs + most_runs]
    Buffer<float> chosen_;    ///< [runs] scratch of its task, region by region
    TaskBody sums_, motions_, totals_body_, starts_;
    TaskBody seam_rises_, strip_rises_;  ///< without launches: no items there
};

}  // namespace weft
