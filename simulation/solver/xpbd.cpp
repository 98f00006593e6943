#include "simulation/solver/xpbd.h"

#include <algorithm>
#include <iterator>

#include "kernels/descent/substep.h"
#include "kernels/motion.h"
#include "runtime/planning/regions.h"
#include "simulation/contact/projection.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "simulation/solver/body_momentum.h"
#include "simulation/solver/narrow_task.h"

namespace weft {

namespace {

/// The multipliers of one family: a buffer per constraint.
using Multipliers = std::vector<std::unique_ptr<Buffer<float>>>;

/// Contacts alone, behind the last iteration: a projection of all at once does a part of each, and
/// what it leaves becomes motion. With none, a knife pushed onto a vertex of cloth left six times
/// the energy there. Not where solids move: they are solved less far than cloth, and contacts that
/// move them alone left blocks below heavy ones strained 4 to 16 times as much.
constexpr int kMoreRounds = 2;

/// What is projected by tasks of its own, and by which.
struct Group {
    std::vector<std::size_t> families;
    TaskBody seams[2], strips[2];  ///< [fresh]
};

bool has_moving_solids(const Model& model) {
    const auto* solids = model.find<Tetrahedra>();
    if (solids == nullptr) return false;
    const auto moves = [&](int vertex) {
        return (*model.positions)[static_cast<std::size_t>(vertex)].w > 0.0f;
    };
    for (int t = 0; t < solids->count(); ++t) {
        if (std::ranges::any_of(solids->corners(t), moves)) return true;
    }
    return false;
}

class XpbdSolver final : public Solver {
public:
    XpbdSolver(Model& model, XpbdTasks tasks)
        : model_(model), contact_(ContactResponse::of(model, /*first_kind=*/0)) {
        if (contact_) {
            kinds_ = contact_->kinds();
            projection_ = std::make_unique<ContactProjection>(model, *contact_);
        }
        if (contact_ || (model.obstacles && has_moving_solids(model))) find_bodies();
        for (const auto& family : model.families) add_multipliers(*family);
        make_predict();
        if (tasks == XpbdTasks::kWhole)
            add_all_in_one();
        else
            add_one_by_one();
        if (contact_) make_push();
        if (has_rounds_) make_round();
        make_velocities();
        narrow_ =
            NarrowTask::of(model,
                           {.iterates = {model.positions.get()},
                            .targets = contact_ ? targets_.get() : nullptr,
                            .pressing = contact_ && momentum_ ? momentum_->pressing() : nullptr,
                            .contact = contact_.get()},
                           static_cast<int>(kinds_.size()));
        if (narrow_) std::ranges::copy(narrow_->kinds(), std::back_inserter(kinds_));
    }

    std::vector<const TaskBody*> bodies() const override {
        std::vector<const TaskBody*> list{&predict_};
        for (const Group& group : groups_) {
            for (const int fresh : {1, 0}) {
                if (!group.families.empty()) list.push_back(&group.seams[fresh]);
                list.push_back(&group.strips[fresh]);
            }
        }
        list.push_back(&velocities_);
        if (narrow_) narrow_->list_bodies(list);
        if (momentum_) momentum_->list_bodies(list);
        if (!lead_.launches.empty()) list.push_back(&lead_);
        if (!contact_) return list;
        list.push_back(&push_);
        if (has_rounds_) list.insert(list.end(), {&show_, &push_again_});
        for (const TaskBody* body : contact_->bodies()) list.push_back(body);
        return list;
    }

    std::vector<std::string> kinds() const override { return kinds_; }

    std::vector<RowTable*> tables() override {
        std::vector<RowTable*> tables;
        if (contact_) tables = contact_->tables();
        if (momentum_) std::ranges::copy(momentum_->tables(), std::back_inserter(tables));
        return tables;
    }
    std::vector<BufferStorage*> state() override {
        std::vector<BufferStorage*> buffers;
        if (contact_) buffers = contact_->state();
        if (RestingBodies* resting = momentum_ ? momentum_->resting() : nullptr)
            buffers.push_back(&resting->slips());
        return buffers;
    }
    ContactResponse* contact() override { return contact_.get(); }

    std::vector<Buffer<float4>*> iterate() override {
        std::vector<Buffer<float4>*> buffers{model_.positions.get()};
        if (contact_) buffers.push_back(&contact_->snapshots());
        if (contact_ && momentum_ && model_.obstacles) buffers.push_back(targets_.get());
        return buffers;
    }

    /// The multipliers count every motion in full, so it must not be lost: where half of it is,
    /// they and the positions do not belong together any more, and iterations end elsewhere.
    Asynchrony asynchrony() const override {
        if (narrow_) return {};  // as in sweeps.cpp
        Asynchrony asynchrony{{}, {}, 1.0f};
        for (const Group& group : groups_) {
            if (!group.families.empty()) asynchrony.kinds.push_back(group.seams[0].kind);
            asynchrony.kinds.push_back(group.strips[0].kind);
            if (group.families.empty()) asynchrony.last.push_back(group.strips[0].kind);
        }
        if (contact_) asynchrony.kinds.push_back(push_.kind);
        return asynchrony;
    }

    Step make_step(const Partition& partition) override {
        const auto regions = regions_of(partition);
        Step step;
        for (const Region& region : regions) add_predict(step, region);
        if (contact_) contact_->add_detection(step, regions);
        if (momentum_) momentum_->add_lead_tasks(step, lead_, regions);
        for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
            add_iteration(step, regions, iteration);
        }
        int last = model_.scene.solver.iterations - 1;
        if (has_rounds_) {
            for (int k = 0; k < kMoreRounds; ++k) add_round(step, regions, ++last);
        }
        if (narrow_) narrow_->add_last(step, regions, last);
        if (contact_ && momentum_) momentum_->add_sums(step, regions, last);
        for (const Region& region : regions) add_velocities(step, last, region);
        if (contact_) contact_->energy().add(step, regions, last);
        step.seal();
        return step;
    }

private:
    /// Projections keep momentum, but what planes take back is lost, and a few iterations let stiff
    /// bodies sink into what bears them. And solids that land on obstacles or others are led out of
    /// these as wholes before the first iteration; without contact that is all.
    void find_bodies() {
        targets_ = std::make_unique<Buffer<float4>>("targets", model_.positions->count());
        momentum_ = std::make_unique<BodyMomentum>(
            model_, contact_.get(), projection_ ? &projection_->multipliers() : nullptr, *targets_,
            BodyMomentum::Solves::kConstraints, static_cast<int>(kinds_.size()));
        if (momentum_->has_bodies() && (contact_ || momentum_->resting())) {
            momentum_->look_at(*model_.positions);
            std::ranges::copy(momentum_->kinds(), std::back_inserter(kinds_));
            lead_ = {"lead", static_cast<int>(kinds_.size()), {}};
            momentum_->add_lead(lead_.launches, fall());
            if (!lead_.launches.empty()) kinds_.push_back(lead_.name);
        } else {
            momentum_.reset();
            targets_.reset();
        }
    }

    /// What gravity does in a substep, and as much again [m]: what lies would come as deep. That is
    /// left to projections, as they rub by how deep it is.
    float fall() const {
        double most = length(model_.scene.gravity);
        for (const GravityKey& key : model_.scene.gravity_keys) {
            most = std::max(most, length(key.gravity));
        }
        return static_cast<float>(2.0 * most * model_.h * model_.h);
    }

    TaskBody new_kind(const std::string& name) {
        kinds_.push_back(name);
        return {name, static_cast<int>(kinds_.size()) - 1, {}};
    }

    void add_all_in_one() {
        Group& group = groups_.emplace_back();
        for (std::size_t f = 0; f < multipliers_.size(); ++f) group.families.push_back(f);
        fill(group, "seams", "strips");
        for (TaskBody& body : group.strips) {
            if (contact_)
                projection_->add_snapshot(body.launches);
            else
                add_obstacles(body);
        }
    }

    void add_one_by_one() {
        for (std::size_t f = 0; f < multipliers_.size(); ++f) {
            Group& group = groups_.emplace_back(Group{{f}, {}, {}});
            const std::string name = model_.families[f]->names().name;
            fill(group, name + "-seams", name);
        }
        if (!model_.obstacles) return;
        Group& group = groups_.emplace_back();
        group.strips[0] = group.strips[1] = new_kind("obstacles");
        for (TaskBody& body : group.strips) add_obstacles(body);
    }

    void fill(Group& group, const std::string& seams, const std::string& strips) {
        group.seams[0] = group.seams[1] = new_kind(seams);
        group.strips[0] = group.strips[1] = new_kind(strips);
        for (const int fresh : {0, 1}) {
            group.seams[fresh].launches = project(group, kSeamPhase, fresh);
            group.strips[fresh].launches = project(group, kInnerPhase, fresh);
        }
    }

    void add_obstacles(TaskBody& body) {
        if (contact_ && momentum_)
            return momentum_->add_obstacles(body.launches, *model_.positions);
        if (!model_.obstacles) return;
        model_.obstacles->add_launches(body.launches, model_.vertices(), *model_.positions,
                                       *model_.previous, {});
    }

    void make_push() {
        push_ = new_kind("push");
        projection_->add_project(push_.launches);
        add_obstacles(push_);
        contact_->add_truncation(push_.launches, *model_.positions,
                                 model_.scene.solver.iterations - 1);
    }

    void make_round() {
        show_ = new_kind("snapshot");
        projection_->add_snapshot(show_.launches);
        push_again_ = new_kind("push-again");
        for (const Launch& launch : push_.launches) {
            if (launch.gate == &contact_->apart()) continue;
            push_again_.launches.push_back(only_where(contact_->rows().touching, launch));
        }
    }

    void make_predict() {
        predict_ = new_kind("predict");
        predict_.launches.push_back(launch(kernels::predict, model_.vertices(), *model_.positions,
                                           *model_.previous, *model_.velocities, *model_.gravity,
                                           static_cast<float>(model_.h), kInstance));
        if (model_.moving_pins)
            model_.moving_pins->add_launches(predict_.launches, *model_.positions);
        // Free vertices are at x~ now.
        if (momentum_) {
            predict_.launches.push_back(
                launch(kernels::start_targets, model_.vertices(), *model_.positions, *targets_));
            momentum_->keep_starts(predict_.launches);
        }
        if (contact_) contact_->add_begin(predict_.launches, *model_.positions);
    }

    void make_velocities() {
        velocities_ = new_kind("velocities");
        const auto update = [&](auto kernel) {
            velocities_.launches.push_back(launch(kernel, model_.vertices(), *model_.positions,
                                                  *model_.previous, *model_.velocities,
                                                  *model_.gravity, static_cast<float>(model_.h),
                                                  static_cast<float>(1.0 / model_.h), kInstance));
        };
        if (model_.damped)
            update(kernels::update_damped_velocities);
        else
            update(kernels::update_velocities);
        if (momentum_) end_bodies();
        if (contact_) contact_->add_count(velocities_.launches);
    }

    void end_bodies() {
        if (contact_) return momentum_->add_moves(velocities_.launches);
        velocities_.launches.push_back(momentum_->resting()->keep_slips());
    }
    void add_end_accesses(Step::Adding& task, const Region& region) {
        if (contact_) return momentum_->add_move_accesses(task, region.strips());
        momentum_->resting()->add_keep_accesses(task, first_vertex(region.begin),
                                                first_vertex(region.end));
    }

    void add_multipliers(const ElementFamily& family) {
        Multipliers& multipliers = multipliers_.emplace_back();
        for (const std::string& constraint : family.constraints()) {
            multipliers.push_back(
                std::make_unique<Buffer<float>>(family.names().name + ".multipliers" + constraint,
                                                static_cast<std::size_t>(family.count())));
        }
    }

    /// One launch per family.
    std::vector<Launch> project(const Group& group, Phase phase, int fresh) {
        const auto inverse_h2 = static_cast<float>(1.0 / (model_.h * model_.h));
        std::vector<Launch> launches;
        for (const std::size_t f : group.families) {
            launches.push_back(model_.families[f]->project(
                {phase, *model_.positions, multipliers_[f], inverse_h2, fresh}));
        }
        return launches;
    }

    int first_vertex(int strip) const {
        return model_.strips.begin[static_cast<std::size_t>(strip)];
    }

    void add_predict(Step& step, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        auto task = step.add(predict_, 0, region.strips(), region.id);
        task.reads(*model_.velocities, begin, end)
            .updates(*model_.positions, begin, end)
            .updates(*model_.previous, begin, end);
        if (momentum_) {
            task.updates(*targets_, begin, end);
            momentum_->add_start_accesses(task, begin, end);
        }
        if (contact_) contact_->add_begin_accesses(task, begin, end);
    }

    void add_velocities(Step& step, int iteration, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        auto task = step.add(velocities_, iteration, region.strips(), region.id);
        task.reads(*model_.positions, begin, end)
            .reads(*model_.previous, begin, end)
            .updates(*model_.velocities, begin, end);
        if (momentum_) add_end_accesses(task, region);
        if (contact_) contact_->add_count_accesses(task, begin, end);
    }

    /// First what crosses from strip to strip, then the strips, then contacts.
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
        for (const Region& region : regions) {
            for_each_part(
                region,
                [&](StripRange seams) {
                    for (const Group& g : groups_) add_seams(step, g, iteration, seams, region.id);
                },
                [&](StripRange strips) {
                    for (const Group& g : groups_)
                        add_strips(step, g, iteration, strips, region.id);
                });
        }
        for (const Region& region : regions) {
            if (contact_) add_push(step, push_, iteration, region);
        }
        if (narrow_) narrow_->add(step, regions, iteration);
    }

    /// An iteration of contacts alone.
    void add_round(Step& step, const std::vector<Region>& regions, int iteration) {
        for (const Region& region : regions) {
            auto task = step.add(show_, iteration, region.strips(), region.id);
            task.reads(*model_.positions, first_vertex(region.begin), first_vertex(region.end));
            projection_->add_snapshot_accesses(task, iteration, region.begin, region.end);
        }
        for (const Region& region : regions) add_push(step, push_again_, iteration, region);
    }

    void add_seams(Step& step, const Group& group, int iteration, StripRange seams, RegionId id) {
        if (group.families.empty()) return;
        const TaskBody& body = group.seams[iteration == 0];
        const auto first = static_cast<std::size_t>(seams.begin);
        const auto last = static_cast<std::size_t>(seams.end - 1);
        auto task = step.add(body, iteration, seams, id);
        task.updates(*model_.positions, model_.strips.seam_begin[first],
                     model_.strips.seam_end[last]);
        update_multipliers(task, group, body);
    }

    void add_strips(Step& step, const Group& group, int iteration, StripRange strips, RegionId id) {
        const int begin = first_vertex(strips.begin), end = first_vertex(strips.end);
        const TaskBody& body = group.strips[iteration == 0];
        auto task = step.add(body, iteration, strips, id);
        task.updates(*model_.positions, begin, end);
        update_multipliers(task, group, body);
        if (contact_) {
            projection_->add_snapshot_accesses(task, iteration, strips.begin, strips.end);
            return;
        }
        const bool has_obstacles = body.launches.size() > group.families.size();
        if (has_obstacles) task.reads(*model_.previous, begin, end);
    }

    void add_push(Step& step, const TaskBody& body, int iteration, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        auto task = step.add(body, iteration, region.strips(), region.id);
        projection_->add_project_accesses(task, iteration, region.begin, region.end);
        contact_->add_truncation_accesses(task, region.strips());
        if (momentum_) return momentum_->add_obstacle_accesses(task, begin, end);
        if (model_.obstacles) task.reads(*model_.previous, begin, end);
    }

    void update_multipliers(Step::Adding& task, const Group& group, const TaskBody& body) {
        for (std::size_t g = 0; g < group.families.size(); ++g) {
            for (const auto& buffer : multipliers_[group.families[g]]) {
                task.updates(*buffer, body.launches[g].segments);
            }
        }
    }

    Model& model_;
    std::vector<Multipliers> multipliers_;  ///< [families] as the model's
    std::vector<std::string> kinds_;
    std::unique_ptr<ContactResponse> contact_;       ///< null: none
    std::unique_ptr<ContactProjection> projection_;  ///< likewise
    std::unique_ptr<Buffer<float4>> targets_;        ///< [vertices] x~; null: no bodies are led
    std::unique_ptr<BodyMomentum> momentum_;         ///< likewise
    std::unique_ptr<NarrowTask> narrow_;             ///< null: no narrow obstacles
    TaskBody predict_, velocities_;
    TaskBody lead_;  ///< empty: no solids that may land on something
    bool has_rounds_ = contact_ && !has_moving_solids(model_);
    TaskBody push_;               ///< empty: no contact
    TaskBody show_, push_again_;  ///< behind the last iteration; empty: no rounds there
    std::vector<Group> groups_;   ///< in the order in which they are projected
};

}  // namespace

std::unique_ptr<Solver> make_xpbd_solver(Model& model, XpbdTasks tasks) {
    return std::make_unique<XpbdSolver>(model, tasks);
}

}  // namespace weft
