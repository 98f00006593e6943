#include "simulation/solver/xpbd.h"

#include <algorithm>

#include "kernels/motion.h"
#include "kernels/xpbd/hinges.h"
#include "kernels/xpbd/springs.h"
#include "simulation/solver/regions.h"

namespace weft {

namespace {

enum Kind { kPredict, kSeams, kStrips, kVelocities };

class XpbdSolver final : public Solver {
public:
    explicit XpbdSolver(Model& model)
        : model_(model),
          spring_multipliers_("springs.multipliers",
                              static_cast<std::size_t>(model.springs->elements.count())) {
        if (model.hinges) {
            hinge_multipliers_ = std::make_unique<Buffer<float>>(
                "hinges.multipliers", static_cast<std::size_t>(model.hinges->elements.count()));
        }
        make_predict();
        for (const int fresh : {0, 1}) {
            seams_[fresh] = {"seams", kSeams, project(kSeamPhase, fresh)};
            strips_[fresh] = {"strips", kStrips, project(kInnerPhase, fresh)};
            if (model.obstacles) {
                model.obstacles->add_launches(strips_[fresh].launches, model.vertices(),
                                              *model.positions, *model.previous);
            }
        }
        make_velocities();
    }

    std::vector<const TaskBody*> bodies() const override {
        return {&predict_, &seams_[1], &strips_[1], &seams_[0], &strips_[0], &velocities_};
    }

    std::vector<std::string> kinds() const override {
        return {"predict", "seams", "strips", "velocities"};
    }

    Step make_step(std::span<const int> cuts) override {
        const auto regions = regions_between(cuts, model_.strips.count());
        Step step;
        for (const Region& region : regions) add_predict(step, region);
        for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
            add_iteration(step, regions, iteration);
        }
        for (const Region& region : regions) add_velocities(step, region);
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
    }

    std::vector<Launch> project(Phase phase, int fresh) {
        const auto inverse_h2 = static_cast<float>(1.0 / (model_.h * model_.h));
        std::vector<Launch> launches;
        Elements& springs = model_.springs->elements;
        launches.push_back(launch(kernels::project_springs, springs.segments(phase),
                                  *model_.positions, springs.vertices(), model_.springs->material,
                                  spring_multipliers_, springs.count(), inverse_h2, fresh));
        if (model_.hinges) {
            Elements& hinges = model_.hinges->elements;
            launches.push_back(launch(kernels::project_hinges, hinges.segments(phase),
                                      *model_.positions, hinges.vertices(), model_.hinges->weights,
                                      *hinge_multipliers_, hinges.count(), inverse_h2, fresh));
        }
        return launches;
    }

    int first_vertex(int strip) const {
        return model_.strips.begin[static_cast<std::size_t>(strip)];
    }

    void add_predict(Step& step, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        step.add(predict_, 0, region.begin, region.end, region.id)
            .reads(*model_.velocities, begin, end)
            .updates(*model_.positions, begin, end)
            .updates(*model_.previous, begin, end);
    }

    void add_velocities(Step& step, const Region& region) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        step.add(velocities_, model_.scene.solver.iterations - 1, region.begin, region.end,
                 region.id)
            .reads(*model_.positions, begin, end)
            .reads(*model_.previous, begin, end)
            .updates(*model_.velocities, begin, end);
    }

    /// First what crosses from strip to strip, then the strips. Only the open seam between two
    /// regions and the strips beside it are shared between devices, so they are tasks of their own.
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
        for (const Region& region : regions) {
            add_seams(step, iteration, region.begin, region.end - 1, region.id);
        }
        for (const Region& region : regions) {
            if (!region.cut_behind) continue;
            add_seams(step, iteration, region.end - 1, region.end, region.id);
        }
        for (const Region& region : regions) {
            for_each_share(region, [&](int begin, int end) {
                add_strips(step, iteration, begin, end, region.id);
            });
        }
    }

    void add_seams(Step& step, int iteration, int begin, int end, int id) {
        end = std::min(end, model_.strips.seam_count());
        if (begin >= end) return;
        const TaskBody& body = seams_[iteration == 0];
        const auto first = static_cast<std::size_t>(begin);
        const auto last = static_cast<std::size_t>(end - 1);
        auto task = step.add(body, iteration, begin, end, id);
        task.updates(*model_.positions, model_.strips.seam_begin[first],
                     model_.strips.seam_end[last]);
        update_multipliers(task, body);
    }

    void add_strips(Step& step, int iteration, int begin, int end, int id) {
        if (begin >= end) return;
        const TaskBody& body = strips_[iteration == 0];
        auto task = step.add(body, iteration, begin, end, id);
        task.updates(*model_.positions, first_vertex(begin), first_vertex(end));
        update_multipliers(task, body);
        if (model_.obstacles && model_.obstacles->have_friction()) {
            task.reads(*model_.previous, first_vertex(begin), first_vertex(end));
        }
    }

    /// Springs are the first launch of a body, hinges the second; see project().
    void update_multipliers(Step::Adding& task, const TaskBody& body) {
        task.updates(spring_multipliers_, body.launches[0].segments);
        if (hinge_multipliers_) task.updates(*hinge_multipliers_, body.launches[1].segments);
    }

    Model& model_;
    Buffer<float> spring_multipliers_;
    std::unique_ptr<Buffer<float>> hinge_multipliers_;
    TaskBody predict_, velocities_;
    TaskBody seams_[2], strips_[2];  ///< [fresh]
};

}  // namespace

std::unique_ptr<Solver> make_xpbd_solver(Model& model) {
    return std::make_unique<XpbdSolver>(model);
}

}  // namespace weft
