#pragma once

#include <memory>
#include <vector>

#include "runtime/planning/regions.h"
#include "simulation/contact/response.h"
#include "simulation/solver/held_sums.h"

namespace weft {

/// Bodies of which some vertices are held (held_body.h): behind the last iteration each is moved as
/// a whole by what makes E less (kernels/bodies/held_bodies.h).
class HeldBodies {
public:
    /// Null: there are none. contact: null: none; both must outlive this. kind: of its task
    static std::unique_ptr<HeldBodies> of(Model& model, ContactResponse* contact, int kind);
    HeldBodies(Model& model, ContactResponse* contact, const std::vector<HeldBody>& bodies,
               int kind);

    /// starts: [vertices] x~ before obstacles pushed; null: there are none. Before what follows.
    void look_at(Buffer<float4>& positions, Buffer<float4>& targets, Buffer<float4>* starts);
    /// Adds up where the bodies are and what holds them, behind the last iteration of all regions.
    const TaskBody& body() const { return body_; }
    void add_sums(Step& step, const std::vector<Region>& regions, int iteration);

    /// Moves the vertices of a region's strips then.
    /// deviations  [vertices] x - x~
    std::vector<Launch> move(Buffer<float4>& deviations);
    void add_move_accesses(Step::Adding& task, StripRange strips);

    HeldSums& sums() { return sums_; }
    /// [runs] Above 0 where anything pushed or touched the body in the substep before; null:
    /// nothing may.
    Buffer<float>* touched() { return touched_.get(); }

private:
    /// x~ as sums see it, where something may push or touch bodies.
    struct Seen {
        Buffer<float4> targets;
        Buffer<float> bodies;  ///< [vertices]
    };
    void number_bodies();
    Launch see(Buffer<float4>& targets, Buffer<float4>* starts);
    HeldSums::Place place();

    Model& model_;
    ContactResponse* contact_;
    HeldSums sums_;
    std::unique_ptr<Seen> seen_;           ///< null: nothing may
    Buffer<float4>* positions_ = nullptr;  ///< behind look_at(), as are
    Buffer<float4>* targets_ = nullptr;
    Buffer<float4>* starts_ = nullptr;
    std::unique_ptr<Buffer<float>> touched_;
    TaskBody body_;
};

}  // namespace weft
