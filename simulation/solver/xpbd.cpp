#include "simulation/solver/xpbd.h"

#include "kernels/motion.h"
#include "kernels/xpbd/hinges.h"
#include "kernels/xpbd/membranes.h"
#include "kernels/xpbd/springs.h"
#include "kernels/xpbd/tetrahedra.h"
#include "simulation/solver/regions.h"

namespace weft {

namespace {

enum Kind { kPredict, kSeams, kStrips, kVelocities };

/// The multipliers of one kind of element: a buffer per constraint.
using Multipliers = std::vector<std::unique_ptr<Buffer<float>>>;

class XpbdSolver final : public Solver {
public:
    explicit XpbdSolver(Model& model) : model_(model) {
        if (model.springs) add_kind("springs", model.springs->elements, {""});
        if (model.membranes) add_kind("membranes", model.membranes->elements, {".area", ".shape"});
        if (model.tetrahedra) {
            add_kind("tetrahedra", model.tetrahedra->elements, {".volume", ".shape"});
        }
        if (model.hinges) add_kind("hinges", model.hinges->elements, {""});
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

    void add_kind(const std::string& name, const Elements& elements,
                  std::initializer_list<const char*> constraints) {
        Multipliers& kind = multipliers_.emplace_back();
        for (const char* constraint : constraints) {
            kind.push_back(std::make_unique<Buffer<float>>(
                name + ".multipliers" + constraint, static_cast<std::size_t>(elements.count())));
        }
    }

    /// One launch per kind of element, in the order of multipliers_.
    std::vector<Launch> project(Phase phase, int fresh) {
        const auto inverse_h2 = static_cast<float>(1.0 / (model_.h * model_.h));
        std::vector<Launch> launches;
        const auto add = [&](auto kernel, Elements& elements, auto&... rest) {
            launches.push_back(launch(kernel, elements.segments(phase), *model_.positions,
                                      elements.vertices(), rest..., elements.count(), inverse_h2,
                                      fresh));
        };
        const auto multipliers = [&](std::size_t constraint = 0) -> Buffer<float>& {
            return *multipliers_[launches.size()][constraint];
        };
        if (model_.springs) {
            add(kernels::project_springs, model_.springs->elements, model_.springs->material,
                multipliers());
        }
        if (model_.membranes) {
            Membranes& membranes = *model_.membranes;
            add(kernels::project_membranes, membranes.elements, membranes.shape, membranes.material,
                multipliers(0), multipliers(1));
        }
        if (model_.tetrahedra) {
            Tetrahedra& tetrahedra = *model_.tetrahedra;
            add(kernels::project_tetrahedra, tetrahedra.elements, tetrahedra.shape,
                tetrahedra.material, multipliers(0), multipliers(1));
        }
        if (model_.hinges) {
            add(kernels::project_hinges, model_.hinges->elements, model_.hinges->weights,
                multipliers());
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

    /// First what crosses from strip to strip, then the strips.
    void add_iteration(Step& step, const std::vector<Region>& regions, int iteration) {
        for (const Region& region : regions) {
            for_each_part(
                region,
                [&](int begin, int end) { add_seams(step, iteration, begin, end, region.id); },
                [&](int begin, int end) { add_strips(step, iteration, begin, end, region.id); });
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
        if (model_.obstacles && model_.obstacles->have_friction()) {
            task.reads(*model_.previous, first_vertex(begin), first_vertex(end));
        }
    }

    void update_multipliers(Step::Adding& task, const TaskBody& body) {
        for (std::size_t kind = 0; kind < multipliers_.size(); ++kind) {
            for (const auto& buffer : multipliers_[kind]) {
                task.updates(*buffer, body.launches[kind].segments);
            }
        }
    }

    Model& model_;
    std::vector<Multipliers> multipliers_;  ///< [kinds of elements that there are]
    TaskBody predict_, velocities_;
    TaskBody seams_[2], strips_[2];  ///< [fresh]
};

}  // namespace

std::unique_ptr<Solver> make_xpbd_solver(Model& model) {
    return std::make_unique<XpbdSolver>(model);
}

}  // namespace weft
