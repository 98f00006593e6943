#include "simulation/solver/xpbd.h"

#include "kernels/motion.h"
#include "runtime/planning/regions.h"
#include "simulation/contact/projection.h"

namespace weft {

namespace {

enum Kind { kPredict, kSeams, kStrips, kVelocities, kPush, kContact };

/// The multipliers of one family: a buffer per constraint.
using Multipliers = std::vector<std::unique_ptr<Buffer<float>>>;

class XpbdSolver final : public Solver {
public:
    explicit XpbdSolver(Model& model)
        : model_(model), contact_(ContactResponse::of(model, kContact)) {
        if (contact_) projection_ = std::make_unique<ContactProjection>(model, *contact_);
        for (const auto& family : model.families) add_multipliers(*family);
        make_predict();
        for (const int fresh : {0, 1}) {
            seams_[fresh] = {"seams", kSeams, project(kSeamPhase, fresh)};
            strips_[fresh] = {"strips", kStrips, project(kInnerPhase, fresh)};
            auto& launches = strips_[fresh].launches;
            if (contact_)
                projection_->add_snapshot(launches);
            else
                add_obstacles(launches);
        }
        if (contact_) make_push();
        make_velocities();
    }

    std::vector<const TaskBody*> bodies() const override {
        std::vector<const TaskBody*> list{&predict_,  &seams_[1],  &strips_[1],
                                          &seams_[0], &strips_[0], &velocities_};
        if (!contact_) return list;
        list.push_back(&push_);
        for (const TaskBody* body : contact_->bodies()) list.push_back(body);
        return list;
    }

    std::vector<std::string> kinds() const override {
        std::vector<std::string> names{"predict", "seams", "strips", "velocities"};
        if (!contact_) return names;
        names.push_back(push_.name);
        for (std::string& kind : contact_->kinds()) names.push_back(std::move(kind));
        return names;
    }

    std::vector<RowTable*> tables() override {
        return contact_ ? contact_->tables() : std::vector<RowTable*>{};
    }
    ContactResponse* contact() override { return contact_.get(); }

    std::vector<Buffer<float4>*> iterate() override { return {model_.positions.get()}; }

    /// The multipliers count every motion in full, so it must not be lost: where half of it is,
    /// they and the positions do not belong together any more, and iterations end elsewhere.
    Asynchrony asynchrony() const override { return {{kSeams, kStrips}, 1.0f}; }

    Step make_step(const Partition& partition) override {
        const auto regions = regions_of(partition);
        Step step;
        for (const Region& region : regions) add_predict(step, region);
        if (contact_) contact_->add_detection(step, regions);
        for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
            add_iteration(step, regions, iteration);
        }
        for (const Region& region : regions) add_velocities(step, region);
        if (contact_) contact_->energy().add(step, regions, model_.scene.solver.iterations - 1);
        step.seal();
        return step;
    }

private:
    void make_predict() {
        predict_ = {"predict", kPredict, {}};
        predict_.launches.push_back(launch(kernels::predict, model_.vertices(), *model_.positions,
                                           *model_.previous, *model_.velocities, *model_.gravity,
                                           static_cast<float>(model_.h), kInstance));
        if (model_.moving_pins)
            model_.moving_pins->add_launches(predict_.launches, *model_.positions);
        // Free vertices are at x~ now.
        if (contact_) contact_->add_begin(predict_.launches, *model_.positions);
    }

    void add_obstacles(std::vector<Launch>& launches) {
        if (!model_.obstacles) return;
        model_.obstacles->add_launches(launches, model_.vertices(), *model_.positions,
                                       *model_.previous);
    }

    void make_push() {
        push_ = {"push", kPush, {projection_->project()}};
        add_obstacles(push_.launches);
        contact_->add_truncation(push_.launches, *model_.positions);
    }

    void make_velocities() {
        velocities_ = {"velocities", kVelocities, {}};
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
        if (contact_) contact_->add_count(velocities_.launches);
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
    std::vector<Launch> project(Phase phase, int fresh) {
        const auto inverse_h2 = static_cast<float>(1.0 / (model_.h * model_.h));
        std::vector<Launch> launches;
        for (std::size_t f = 0; f < multipliers_.size(); ++f) {
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
        auto task = step.add(predict_, 0, region.begin, region.end, region.id);
        task.reads(*model_.velocities, begin, end)
            .updates(*model_.positions, begin, end)
            .updates(*model_.previous, begin, end);
        if (contact_) contact_->add_begin_accesses(task, begin, end);
    }

    void add_velocities(Step& step, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        auto task = step.add(velocities_, model_.scene.solver.iterations - 1, region.begin,
                             region.end, region.id);
        task.reads(*model_.positions, begin, end)
            .reads(*model_.previous, begin, end)
            .updates(*model_.velocities, begin, end);
        if (contact_) contact_->add_count_accesses(task, begin, end);
    }

    /// First what crosses from strip to strip, then the strips, then contacts.
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
        for (const Region& region : regions) {
            for_each_part(
                region,
                [&](int begin, int end) { add_seams(step, iteration, begin, end, region.id); },
                [&](int begin, int end) { add_strips(step, iteration, begin, end, region.id); });
        }
        for (const Region& region : regions) {
            if (contact_) add_push(step, iteration, region);
        }
    }

    void add_seams(Step& step, int iteration, int begin, int end, int id) {
        const TaskBody& body = seams_[iteration == 0];
        const auto first = static_cast<std::size_t>(begin);
        const auto last = static_cast<std::size_t>(end - 1);
        auto task = step.add(body, iteration, begin, end, id);
        task.updates(*model_.positions, model_.strips.seam_begin[first],
                     model_.strips.seam_end[last]);
        update_multipliers(task, body);
    }

    void add_strips(Step& step, int iteration, int begin, int end, int id) {
        const TaskBody& body = strips_[iteration == 0];
        auto task = step.add(body, iteration, begin, end, id);
        task.updates(*model_.positions, first_vertex(begin), first_vertex(end));
        update_multipliers(task, body);
        if (contact_) {
            projection_->add_snapshot_accesses(task, iteration, first_vertex(begin),
                                               first_vertex(end));
        } else if (model_.obstacles) {
            task.reads(*model_.previous, first_vertex(begin), first_vertex(end));
        }
    }

    void add_push(Step& step, int iteration, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        auto task = step.add(push_, iteration, region.begin, region.end, region.id);
        projection_->add_project_accesses(task, iteration, region.begin, region.end);
        contact_->add_truncation_accesses(task, begin, end);
        if (model_.obstacles) task.reads(*model_.previous, begin, end);
    }

    void update_multipliers(Step::Adding& task, const TaskBody& body) {
        for (std::size_t f = 0; f < multipliers_.size(); ++f) {
            for (const auto& buffer : multipliers_[f]) {
                task.updates(*buffer, body.launches[f].segments);
            }
        }
    }

    Model& model_;
    std::vector<Multipliers> multipliers_;           ///< [families] as the model's
    std::unique_ptr<ContactResponse> contact_;       ///< null: none
    std::unique_ptr<ContactProjection> projection_;  ///< likewise
    TaskBody predict_, velocities_;
    TaskBody push_;                  ///< empty: no contact
    TaskBody seams_[2], strips_[2];  ///< [fresh]
};

}  // namespace

std::unique_ptr<Solver> make_xpbd_solver(Model& model) {
    return std::make_unique<XpbdSolver>(model);
}

}  // namespace weft
