#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/planning/regions.h"
#include "runtime/row_table.h"
#include "runtime/step.h"
#include "runtime/trace/records.h"
#include "simulation/contact/account.h"
#include "simulation/contact/common_motion.h"
#include "simulation/contact/energy.h"
#include "simulation/contact/frozen.h"
#include "simulation/contact/incidence.h"
#include "simulation/contact/insides.h"
#include "simulation/contact/pairs.h"
#include "simulation/contact/sticking.h"
#include "simulation/contact/truncation.h"
#include "simulation/model/model.h"

namespace weft {

class Executor;

/// What bodies do where they touch each other or themselves: finds contacts at a substep's begin,
/// pushes bodies apart in every iteration, and has the last word about where vertices may be. See
/// kernels/contact/: rows.h how contacts push, truncation.h why nothing passes through.
class ContactResponse {
public:
    /// Null: the scene has no [contact], or nothing that could touch. first_kind: of its tasks
    static std::unique_ptr<ContactResponse> of(Model& model, int first_kind);

    std::vector<const TaskBody*> bodies() const;
    std::vector<std::string> kinds() const;
    std::vector<RowTable*> tables();

    /// What bodies do together in the frame that is to come.
    CommonMotion& motion() { return motion_; }
    /// Whether a frame that has just run went another way than was foreseen; then it has to be done
    /// again, with less foreseen.
    bool revise(Executor& executor);

    /// From now on no substep is the next one of those before. What this gives is to be shown to
    /// the devices.
    BufferStorage& forget() { return pairs_.candidates().forget(); }

    /// Behind what begins a substep: where contacts are to be looked for.
    void add_begin(std::vector<Launch>& launches, Buffer<float4>& targets);
    void add_begin_accesses(Step::Adding& task, int first, int last);
    /// Behind all of that: the tasks that find contacts, take the start back to where they allow it
    /// to be, and show it to all.
    void add_detection(Step& step, const std::vector<Region>& regions);

    /// The contacts' part of gradients and Hessian blocks, behind that of the elements.
    Launch gather(Phase phase, Buffer<float4>& positions, VertexItems& items, Buffer<float>& sums);
    /// The same where the positions are those that all vertices share.
    Launch gather_at(Phase phase, Buffer<float4>& shared, VertexItems& items, Buffer<float>& sums);
    /// What the first needs, of vertices in strips [first_strip, end_strip).
    void add_gather_accesses(Step::Adding& task, int iteration, int first_strip, int end_strip);

    /// Takes vertices back to where contacts allow them to be. Nothing moves them behind it.
    /// all_from: the iteration from which on it is done with vertices that have no pairs, too;
    /// until then nothing else knows whether they stay in their balls
    void add_truncation(std::vector<Launch>& launches, Buffer<float4>& positions, int all_from = 0);
    /// What that needs of its own strips.
    void add_truncation_accesses(Step::Adding& task, StripRange strips) {
        truncation_.add_accesses(task, strips);
    }
    /// Shows the positions to all in the next iteration.
    void add_snapshot(std::vector<Launch>& launches, Buffer<float4>& positions);
    void add_snapshot_accesses(Step::Adding& task, int iteration, int first_strip, int end_strip);
    /// Likewise what the substep has led elsewhere since rows were filled: to the first iteration,
    /// and to who hears late of others.
    void add_start_snapshots(std::vector<Launch>& launches, Buffer<float4>& positions);
    void add_start_snapshot_accesses(Step::Adding& task, StripRange strips);
    /// [2 * vertices] what is shown: to even iterations in the first half, to odd ones in the
    /// second.
    Buffer<float4>& snapshots() { return snapshots_; }
    /// [vertices] how far each is from its planes [m]; WEFT_NO_PLANE where it has no pairs, and so
    /// nobody reads its snapshots.
    Buffer<float>& least() { return truncation_.least(); }
    /// What a substep begins with in both halves, instead of the positions; in the task that fills
    /// the rows.
    void show_start(Launch even, Launch odd);

    /// At a substep's end: counts who was taken back.
    void add_count(std::vector<Launch>& launches);
    void add_count_accesses(Step::Adding& task, int first, int last);

    /// What a frame tells of itself.
    ContactAccount& account() { return account_; }
    /// Null: there are no convex obstacles to be inside of.
    Insides* insides() { return insides_.get(); }
    /// What there was to do in a frame of which the host has the account.
    ContactRecord record();

    ContactTruncation& truncation() { return truncation_; }
    /// [strips] where nothing but balls holds vertices: 1; else 0.
    Buffer<int>& apart() { return truncation_.apart(); }
    /// [vertices] whom the last truncation took back: not 0.
    Buffer<int>& cut() { return truncation_.cut(); }
    /// [vertices] how many contacts each has.
    Buffer<int>& counts() { return contacts_.counts(); }
    ContactRows rows();
    Rubbing rubbing() const;
    /// Those of the last substep; the host has rows().
    std::vector<FrozenContact> frozen();
    /// From now on these are the contacts: for those who know what a substep has found, and solve
    /// it once more, without planes. corners: new order; targets: [vertices] x~
    void put(std::span<const FrozenContact> contacts, std::span<const float4> positions,
             std::span<const float4> targets);
    ContactEnergy& energy() { return energy_; }
    /// What a simulation carries from frame to frame; see Solver::state().
    std::vector<BufferStorage*> state();

private:
    ContactResponse(Model& model, int first_kind);
    void make_fill();
    void add_fill(Step& step, const Region& region);
    void add_pair_accesses(Step::Adding& task, const Region& region);
    /// second_half: where it begins
    Launch gather_from(Phase phase, Buffer<float4>& positions, Buffer<float4>& snapshots,
                       int second_half, VertexItems& items, Buffer<float>& sums);
    Launch snapshot(Buffer<float4>& positions, int ahead);
    std::pair<int, int> vertices(int first_strip, int end_strip) const;

    Model& model_;
    float range_, floor_;
    float friction_, creep_;  ///< 0: none; [m] see kernels/contact/friction.h
    Buffer<float4> anchors_, strides_, goals_;
    Buffer<float> stiffness_;
    ContactPairs pairs_;
    CommonMotion motion_;
    Buffer<float> quiet_;  ///< [vertices] how far each may get before a triangle could turn over
    SurfaceIncidence incidence_;
    Buffer<int> busy_;                          ///< [patches] kernels/contact/fill.h
    Buffer<int> touching_, meeting_, filling_;  ///< [strips] kernels/contact/gates.h
    int fill_kind_;
    ContactTruncation truncation_;
    RowTable contacts_;
    Buffer<int>&corner0_, &corner1_, &corner2_, &corner3_;
    Buffer<float4>&normals_, &weights_, &measures_;
    Buffer<float4>& slips_;               ///< without friction: normals_
    std::unique_ptr<Sticking> sticking_;  ///< without friction: none
    ContactAccount account_;
    std::unique_ptr<Insides> insides_;  ///< without convex obstacles: none
    Buffer<float4> snapshots_;
    TaskBody fill_;
    std::size_t showing_ = 0;  ///< where its launches show the start
    ContactEnergy energy_;
};

}  // namespace weft
