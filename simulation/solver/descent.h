#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/body_momentum.h"
#include "simulation/solver/halo.h"
#include "simulation/solver/narrow_task.h"
#include "simulation/solver/reactions.h"
#include "simulation/solver/stiff_starts.h"
#include "simulation/solver/tied_parts.h"

namespace weft {

/// How substeps begin and end in all methods that descend E(x); see kernels/descent/substep.h.
class DescentSubstep {
public:
    /// first_kind: of tasks that are not the solver's own, if there are any
    DescentSubstep(Model& model, BodyMomentum::Solves solves, int first_kind);

    /// What the first and the last task of a substep launch.
    std::vector<Launch> begin();
    std::vector<Launch> end();
    Step::Adding add_begin(Step& step, const TaskBody& body, const Region& region);
    Step::Adding add_end(Step& step, const TaskBody& body, const Region& region, int iteration);
    /// Behind the ends of all regions: what is measured of a substep.
    void add_measurements(Step& step, const std::vector<Region>& regions, int iteration);

    /// Lets what soft ties hold begin where these lead it as a whole.
    void lead_tied_parts();
    /// Lets what is stiff start from the shape it had, where that is the better start.
    void choose_starts(const StiffStarts::Setting& setting);
    /// Behind the beginnings of all regions.
    void add_start(Step& step, const std::vector<Region>& regions);

    /// Leads bodies as wholes before the first iteration, too, where there is reason to.
    void lead_bodies();
    /// Behind detection.
    void add_lead(Step& step, const std::vector<Region>& regions);

    /// Where the iterates are; without it obstacles keep out vertices alone.
    /// snapshots: as in NarrowTask::Setting
    void keep_triangles_out(std::vector<Buffer<float4>*> iterates, bool snapshots);
    /// Before the first iteration, of solvers that must not begin inside; behind an iteration of
    /// all regions. iterate: in which of those it ended
    void add_first_narrow(Step& step, const std::vector<Region>& regions);
    void add_narrow(Step& step, const std::vector<Region>& regions, int iteration,
                    std::size_t iterate = 0);
    /// Behind the last one of all.
    void add_last_narrow(Step& step, const std::vector<Region>& regions, int iteration,
                         std::size_t iterate = 0);
    /// Whether that does anything.
    bool has_narrow() const { return narrow_ != nullptr; }

    /// With what to find out what obstacles bear of free bodies, if they do (Reactions::Setting).
    /// Behind keep_triangles_out().
    void look_at_reactions(VertexItems& items, VertexDerivatives& derivatives,
                           std::vector<Phase> phases, Buffer<float4>& positions,
                           bool keeps_blocks = false);
    /// Free bodies, and obstacles' pushes.
    BodyMomentum& momentum() { return momentum_; }
    /// What free bodies lack behind the last iteration of all regions, and the last narrow one.
    void add_sums(Step& step, const std::vector<Region>& regions, int iteration);

    /// What there is besides the solver's own: tasks for momentum, and for contacts.
    void list_bodies(std::vector<const TaskBody*>& bodies) const;
    void list_kinds(std::vector<std::string>& kinds) const;
    std::vector<RowTable*> tables();

    /// Contacts between bodies; null: none.
    ContactResponse* contact() { return contact_.get(); }

    /// [vertices] x~; between substeps x - x~, which the next one starts from.
    Buffer<float4>& targets() { return targets_; }
    /// See Solver::state().
    std::vector<BufferStorage*> state();

    /// The vertices of strips [first_strip, end_strip).
    std::pair<int, int> vertices(int first_strip, int end_strip) const;

private:
    int next_kind() const;

    Model& model_;
    Buffer<float4> targets_;
    std::unique_ptr<ContactResponse> contact_;
    BodyMomentum momentum_;
    std::unique_ptr<TiedParts> ties_;       ///< null: none, or nobody asked for it
    std::unique_ptr<StiffStarts> starts_;   ///< null: likewise
    TaskBody lead_;                         ///< empty: bodies are led behind iterations alone
    std::unique_ptr<NarrowTask> narrow_;    ///< null: no narrow obstacles
    std::unique_ptr<Reactions> reactions_;  ///< null: no obstacles that push free bodies
    int first_kind_;
};

}  // namespace weft
