#include "simulation/solver/xpbd.h"

#include <algorithm>

#include "kernels/motion.h"
#include "kernels/xpbd/hinges.h"
#include "kernels/xpbd/springs.h"

namespace weft {

namespace {

enum Kind { kPredict, kSeams, kStrips, kVelocities };

/// The strips of one region.
struct Region {
    int begin = 0;
    int end = 0;
    bool cut_before = false;  ///< another region ends where it begins
    bool cut_behind = false;
};

std::vector<Region> regions_between(std::span<const int> cuts, int strip_count) {
    std::vector<Region> regions{{0, strip_count, false, false}};
    for (const int cut : cuts) {
        regions.back().end = cut;
        regions.back().cut_behind = true;
        regions.push_back({cut, strip_count, true, false});
    }
    return regions;
}

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
        for (std::size_t r = 0; r < regions.size(); ++r) add_predict(step, regions[r], id(r));
        for (int iteration = 0; iteration < model_.scene.solver.iterations; ++iteration) {
            add_iteration(step, regions, iteration);
        }
        for (std::size_t r = 0; r < regions.size(); ++r) add_velocities(step, regions[r], id(r));
        step.seal();
        return step;
    }

private:
    static int id(std::size_t region) { return static_cast<int>(region); }

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

    void add_predict(Step& step, const Region& region, int id) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        step.add(predict_, 0, region.begin, region.end, id)
            .reads(*model_.velocities, begin, end)
            .updates(*model_.positions, begin, end)
            .updates(*model_.previous, begin, end);
    }

    void add_velocities(Step& step, const Region& region, int id) {
        const int begin = first_vertex(region.begin);
        const int end = first_vertex(region.end);
        step.add(velocities_, model_.scene.solver.iterations - 1, region.begin, region.end, id)
            .reads(*model_.positions, begin, end)
            .reads(*model_.previous, begin, end)
            .updates(*model_.velocities, begin, end);
    }

    /// First what crosses from strip to strip, then the strips. Only the open seam between two
    /// regions and the strips beside it are shared between devices, so they are tasks of their own.
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
        for (std::size_t r = 0; r < regions.size(); ++r) {
            add_seams(step, iteration, regions[r].begin, regions[r].end - 1, id(r));
        }
        for (std::size_t r = 0; r + 1 < regions.size(); ++r) {
            add_seams(step, iteration, regions[r].end - 1, regions[r].end, id(r));
        }
        for (std::size_t r = 0; r < regions.size(); ++r) {
            add_region(step, iteration, regions[r], id(r));
        }
    }

    /// A region's strips, in an order that hides the exchange. The region before a cut does the
    /// open seam and its own strip beside it early in an iteration; the region behind does its
    /// strip half-way: so either may be half an iteration ahead of the other before it has to wait.
    void add_region(Step& step, int iteration, const Region& region, int id) {
        const int far_begin = region.cut_before ? region.begin + 1 : region.begin;
        const int far_end = region.cut_behind ? std::max(region.end - 1, far_begin) : region.end;
        const int half = region.cut_before ? far_begin + (far_end - far_begin + 1) / 2 : far_end;
        add_strips(step, iteration, far_end, region.end, id);
        add_strips(step, iteration, far_begin, half, id);
        add_strips(step, iteration, region.begin, far_begin, id);
        add_strips(step, iteration, half, far_end, id);
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
