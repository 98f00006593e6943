#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/step.h"
#include "simulation/contact/response.h"
#include "simulation/model/model.h"
#include "simulation/solver/cloth_reactions.h"
#include "simulation/solver/held_bodies.h"
#include "simulation/solver/lone_bodies.h"
#include "simulation/solver/touching_bodies.h"

namespace weft {

/// What keeps the momentum of bodies, however far iterations get. Behind the last one they are
/// moved as wholes: those that nothing holds by what is missing (kernels/bodies/free_bodies.h), and
/// where something may touch them as far as that lets them (kernels/contact/bodies.h); others as
/// far as what holds them lets them (kernels/bodies/held_bodies.h). Pushes by obstacles are no
/// loss: they move x~ along.
class BodyMomentum {
public:
    /// What a solver solves, one after the other.
    enum class Solves {
        kVertices,     ///< a system of each vertex
        kAll,          ///< one of all of them
        kConstraints,  ///< by projections, which keep momentum; bodies that are held stay as they
                       ///< are
    };
    /// contact: null: none. multipliers: [entries of its rows] by which contacts rub; null: they do
    /// so as their gaps say. targets: [vertices] x~. first_kind: of the tasks, if there are any.
    /// All others must outlive this.
    BodyMomentum(Model& model, ContactResponse* contact, Buffer<float>* multipliers,
                 Buffer<float4>& targets, Solves solves, int first_kind);

    bool has_bodies() const { return free_bodies_ || held_; }
    HeldBodies* held() { return held_.get(); }  ///< null: none
    /// Null: nothing is free.
    const FreeBodies* bodies() const { return free_bodies_.get(); }

    /// Behind what makes x~ and `previous` at a substep's begin: keeps x~ for what obstacles push.
    void keep_starts(std::vector<Launch>& launches);
    /// What that needs of vertices [first, last).
    void add_start_accesses(Step::Adding& task, int first, int last);

    /// x~ before obstacles have pushed; null: there are none.
    Buffer<float4>* starts() { return starts_.get(); }
    /// What obstacles press, of a substep (kernels/obstacles/contact.h); null: nobody asks.
    Buffer<float4>* pressing() { return pressing_.get(); }

    /// Bodies on convex obstacles; null: none.
    RestingBodies* resting() { return touching_ ? touching_->resting() : nullptr; }

    /// Whether what obstacles bear of cloth is found by these systems (cloth_reactions.h). They
    /// then push before the first iteration, too.
    bool solves_cloth() const { return cloth_ != nullptr; }
    /// Leads x~ of the items of a phase by that, behind their sums.
    Launch lead_cloth(VertexItems& items, Phase phase, Buffer<float4>& positions,
                      Buffer<float>& sums);
    /// What that needs of vertices [first, last), besides what the solver needs.
    void add_cloth_accesses(Step::Adding& task, int first, int last);

    /// Pushes vertices out of obstacles, behind an iteration; nothing without any.
    void add_obstacles(std::vector<Launch>& launches, Buffer<float4>& positions);
    /// What that needs of vertices [first, last), besides the positions.
    void add_obstacle_accesses(Step::Adding& task, int first, int last);

    /// positions: those after the last iteration. Before anything that follows here.
    void look_at(Buffer<float4>& positions);
    /// Adds up what is missing, behind the last iteration of all regions; nothing without bodies.
    void add_sums(Step& step, const std::vector<Region>& regions, int iteration);

    /// Leads bodies as wholes before the first iteration, too, where there is reason to; contacts
    /// have the last word. Behind look_at(); nothing otherwise. (xpbd shows by itself where that
    /// has led them.) less: as TouchingBodies::lead()'s
    void add_lead(std::vector<Launch>& launches, float less = 0.0f);
    /// Where that is done: adds up how far, from the positions that contacts were found at, and
    /// then does it. lead: with these launches; nothing if there are none
    void add_lead_tasks(Step& step, const TaskBody& lead, const std::vector<Region>& regions);

    /// Moves bodies, behind the velocities of a substep; obstacles and contacts have the last word.
    void add_moves(std::vector<Launch>& launches);
    /// What that needs of its own strips.
    void add_move_accesses(Step::Adding& task, StripRange strips);

    void list_bodies(std::vector<const TaskBody*>& bodies) const;
    std::vector<std::string> kinds() const;
    std::vector<RowTable*> tables();

private:
    void add_lone_sums(Step& step, const std::vector<Region>& regions, int iteration);
    void add_lead_accesses(Step::Adding& task, StripRange strips);

    Model& model_;
    ContactResponse* contact_;
    Buffer<float4>& targets_;
    bool has_multipliers_;
    Buffer<float4>* positions_ = nullptr;
    std::unique_ptr<ClothReactions> cloth_;     ///< null: none
    std::unique_ptr<FreeBodies> free_bodies_;   ///< null: none
    std::unique_ptr<TouchingBodies> touching_;  ///< null: nothing may touch a free body
    std::unique_ptr<LoneBodies> lone_;          ///< null: no free bodies, or those
    std::unique_ptr<HeldBodies> held_;          ///< null: none
    std::unique_ptr<Buffer<float4>> moved_;     ///< null: nothing has the last word behind moves
    std::unique_ptr<Buffer<float4>> starts_;    ///< x~ before pushes; null: no obstacles
    std::unique_ptr<Buffer<float4>> pressing_;  ///< null: no bodies that rest
    TaskBody sums_;                             ///< empty: no free bodies
};

}  // namespace weft
