#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/regions.h"
#include "simulation/contact/response.h"
#include "simulation/solver/body_hinge.h"
#include "simulation/solver/derivatives.h"
#include "simulation/solver/moment_sums.h"

namespace weft {

/// Solids of which some vertices are held, and cloth that hangs to one side of what holds it:
/// behind the last iteration each is moved as a whole by what makes E less
/// (kernels/bodies/held_bodies.h).
class HeldBodies {
public:
    /// Null: there are none. contact: null: none; both must outlive this. kind: of its task
    static std::unique_ptr<HeldBodies> of(Model& model, ContactResponse* contact, int kind);

    /// A body, and where it is held.
    struct Held {
        FreeBodies::Whole whole;
        std::vector<int> vertices;
        BodyHinge hinge;
    };
    HeldBodies(Model& model, ContactResponse* contact, const std::vector<Held>& bodies, int kind);

    /// starts: [vertices] x~ before obstacles pushed; null: there are none. Before what follows.
    void look_at(Buffer<float4>& positions, Buffer<float4>& targets, Buffer<float4>* starts);
    /// Adds up where the bodies are and what holds them, behind the last iteration of all regions.
    const TaskBody& sums() const { return body_; }
    void add_sums(Step& step, const std::vector<Region>& regions, int iteration);

    /// Moves the vertices of a region's strips then.
    /// deviations  [vertices] x - x~
    std::vector<Launch> move(Buffer<float4>& deviations);
    void add_move_accesses(Step::Adding& task);

private:
    /// x~ as sums see it, where something may push or touch bodies.
    struct Seen {
        Buffer<float4> targets;
        Buffer<float> bodies;  ///< [vertices]
    };
    /// Vertices [begin, end).
    struct VertexRange {
        int begin, end;
    };
    void find_seen();
    VertexRange seen_by(const Region& region) const;
    void number_bodies();
    void fill_runs(const std::vector<Held>& bodies);
    Launch see(Buffer<float4>& targets, Buffer<float4>* starts);
    void add_pulls();
    void add_end_reads(Step::Adding& task, const Region& region);

    Model& model_;
    ContactResponse* contact_;
    std::unique_ptr<Seen> seen_;           ///< null: nothing may
    Buffer<float4>* positions_ = nullptr;  ///< behind look_at(), as is
    Buffer<float4>* targets_ = nullptr;
    FreeBodies bodies_;  ///< what of them is free
    MomentSums moments_;
    VertexItems items_;  ///< what is held
    VertexDerivatives derivatives_;
    FreeBodies holds_;                  ///< the same runs, of these items
    std::vector<VertexRange> seen_by_;  ///< [strips] what elements of held vertices have there
    Buffer<int> runs_;                  ///< [columns] see the kernels for these and the following
    Buffer<int> ends_;                  ///< [2 * runs]
    Buffer<float> numbers_;             ///< [3 * runs]
    Buffer<float4> pulls_;
    Buffer<float4> hinges_;   ///< [2 * runs]
    Buffer<float4> motions_;  ///< [3 * (runs + 1)] each region makes those of its own runs
    TaskBody body_;
};

}  // namespace weft
