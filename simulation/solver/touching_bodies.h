#pragma once

#include <memory>
#include <vector>

#include "simulation/contact/body_pushes.h"
#include "simulation/contact/response.h"
#include "simulation/solver/body_moments.h"
#include "simulation/solver/body_stops.h"
#include "simulation/solver/body_strains.h"
#include "simulation/solver/free_bodies.h"
#include "simulation/solver/resting_bodies.h"

namespace weft {

/// Free bodies in scenes with contact, or with solids that may lie on convex obstacles: they move
/// as wholes as far as what touches them lets them (kernels/contact/bodies.h). Their moments are
/// added up and what pushes them is collected; then there are sums as FreeBodies', and a task of
/// one device that makes steps of them, in turns.
class TouchingBodies {
public:
    /// Null: nothing may touch a free body.
    /// contact: null: none. multipliers: as BodyPushes'. held: as in missing_motion
    /// (kernels/bodies/free_bodies.h). first_kind: of the tasks. All others must outlive this.
    static std::unique_ptr<TouchingBodies> of(Model& model, FreeBodies& bodies,
                                              ContactResponse* contact, Buffer<float>* multipliers,
                                              float held, int first_kind);

    /// As FreeBodies', of the first round. kind: of the tasks that do it
    std::vector<Launch> sum(Buffer<float4>& positions, Buffer<float4>& targets,
                            const ObstaclePushes& obstacles, int kind);
    /// All rounds: sums, each followed by steps. body: with what sum() gave
    void add_rounds(Step& step, const TaskBody& body, const std::vector<Region>& regions,
                    Buffer<float4>& positions, int iteration);
    /// Moves the vertices of a region's strips then.
    Launch move(Model& model, Buffer<float4>& deviations);

    /// Whether there is reason to lead them before the first iteration, too: solids that may touch
    /// others, or obstacles.
    bool may_be_led() const { return solids_ && (may_touch_others() || resting_); }
    /// From now on they are (with multipliers sheets, too), by what moves the vertices of a
    /// region's strips behind add_first_rounds(), by so much less far [m]. Behind sum().
    Launch lead(float less);
    /// body: as add_rounds'
    void add_first_rounds(Step& step, const TaskBody& body, const std::vector<Region>& regions);
    /// Where they have got to is what that reads, as do the sums.
    void add_motion_accesses(Step::Adding& task);

    /// What there is besides the sums of the first round.
    std::vector<const TaskBody*> bodies() const;
    std::vector<std::string> kinds() const { return {collect_.name, steps_.name}; }
    RowTable& table() { return pushes_.table(); }
    /// Null: nothing may lie on a convex obstacle as a whole.
    RestingBodies* resting() { return resting_.get(); }

private:
    TouchingBodies(Model& model, FreeBodies& bodies, ContactResponse* contact,
                   std::unique_ptr<RestingBodies> resting, Buffer<float>* multipliers, float held,
                   int first_kind);
    Buffer<float4>* starts();
    std::vector<Launch> collect(Buffer<float4>& positions);
    std::vector<Launch> sum_round(const BodyPushes::Round& round);
    Launch solve_strains();
    void add_collection(Step& step, const TaskBody& body, const Region& region,
                        Buffer<float4>& positions, int iteration);
    struct Rounds {
        int count, iteration;
    };
    void add_all(Step& step, const TaskBody& collection, const TaskBody& body,
                 const std::vector<Region>& regions, Buffer<float4>& positions, Rounds rounds);
    void add_sum(Step& step, const TaskBody& body, const Region& region, int iteration);
    void add_steps(Step& step, const TaskBody& body, int iteration);
    void number_bodies(const Model& model);
    Segments all() const { return {&begin_, 0, 1, model_.strips.count()}; }
    std::vector<Launch> solve(int has_moved, int level);
    int body_count() const { return bodies_.body_count(); }
    int level_count() const { return groups_ ? groups_->level_count() : 1; }
    bool is_solid(int body) const;
    /// Bodies, or obstacles that are meshes.
    bool may_touch_others() const { return groups_ && model_.bodies.size() > 1; }
    /// Behind the last iteration.
    int round_count() const;

    Model& model_;
    FreeBodies& bodies_;
    std::unique_ptr<RestingBodies> resting_;  ///< null: see resting()
    std::unique_ptr<BodyStops> stops_;        ///< null: nobody stops as a whole
    float held_;
    bool has_multipliers_;
    int is_rubbed_;  ///< 1 with friction
    int parts_;      ///< that are summed up
    BodyPushes pushes_;
    BodyGroups* groups_;  ///< null: bodies do not touch each other
    int lag_count_;
    // See the kernels.
    Buffer<float4> partials_;       ///< [parts * columns]
    Buffer<float4> lags_;           ///< [parts * lag_count]
    Buffer<int> body_of_;           ///< [vertices]
    Buffer<int> column_bodies_;     ///< [columns]
    Buffer<int> first_run_;         ///< [bodies]
    Buffer<float> counts_;          ///< [bodies]
    Buffer<float> masses_;          ///< [bodies]
    Buffer<float4> rests_;          ///< [7 * bodies]
    Buffer<float4> group_motions_;  ///< [3 * bodies]
    Buffer<float4> motions_;        ///< [2 * (bodies + 1)]
    Buffer<float4> strains_;        ///< [2 * (bodies + 1)]
    Buffer<float4> bearings_;       ///< [4 * (bodies + 1)]
    Buffer<float> are_led_;         ///< [bodies + 1]
    BodyMoments moments_;
    Buffer<int> begin_;                    ///< [strips + 1] all bodies are items of strip 0
    std::unique_ptr<BodyStrains> solids_;  ///< null: only cloth is free
    Buffer<float4>* targets_ = nullptr;
    ObstaclePushes obstacles_;
    TaskBody first_collect_, collect_, weigh_, steps_;
    TaskBody strain_sums_, strain_steps_;
    /// Of the rounds behind the first one, by levels of groups; sums behind strains are others.
    std::vector<TaskBody> sums_again_, strained_sums_, steps_again_;
};

}  // namespace weft
