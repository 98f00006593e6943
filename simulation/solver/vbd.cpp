#include "simulation/solver/vbd.h"

#include <algorithm>

#include "kernels/vbd/solve.h"
#include "simulation/solver/descent.h"
#include "simulation/solver/slopes.h"

namespace weft {

namespace {

enum Kind { kPredict, kSeams, kStrips, kVelocities };

class VbdSolver final : public Solver {
public:
    explicit VbdSolver(Model& model)
        : model_(model),
          substep_(model),
          items_(make_vertex_layout(all_stencils(model), model.strips)),
          slopes_(model, items_),
          predict_{"predict", kPredict, substep_.begin()},
          seams_{"seams", kSeams, {}},
          strips_{"strips", kStrips, {}},
          velocities_{"velocities", kVelocities, substep_.end()} {
        solve(kSeamPhase, seams_);
        solve(kInnerPhase, strips_);
        substep_.add_contacts(strips_.launches, *model.positions);
    }

    std::vector<const TaskBody*> bodies() const override {
        return {&predict_, &seams_, &strips_, &velocities_};
    }
    std::vector<std::string> kinds() const override {
        return {"predict", "seams", "strips", "velocities"};
    }
    std::vector<BufferStorage*> state() override { return {&substep_.targets()}; }

    Step make_step(std::span<const int> cuts) override {
        const auto regions = regions_between(cuts, model_.strips.count());
        const int iterations = model_.scene.solver.iterations;
        Step step;
        for (const Region& region : regions) substep_.add_begin(step, predict_, region);
        for (int i = 0; i < iterations; ++i) add_iteration(step, regions, i);
        for (const Region& region : regions) {
            substep_.add_end(step, velocities_, region, iterations - 1);
        }
        step.seal();
        return step;
    }

private:
    void solve(Phase phase, TaskBody& body) {
        body.launches = slopes_.gather(phase, *model_.positions);
        body.launches.push_back(launch(kernels::solve_vertices, items_.segments(phase),
                                       *model_.positions, substep_.targets(), items_.vertices(),
                                       slopes_.sums(), items_.count(),
                                       static_cast<float>(1.0 / (model_.h * model_.h))));
        body.taking_turns = static_cast<int>(body.launches.size());
    }

    /// As XPBD's: seams first, the open ones as tasks of their own; then strips.
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

    /// The vertices of a seam lie within its hull; their elements reach into both strips.
    void add_seams(Step& step, int iteration, int begin, int end, int region) {
        end = std::min(end, model_.strips.seam_count());
        if (begin >= end) return;
        const int first = model_.strips.seam_begin[static_cast<std::size_t>(begin)];
        const int last = model_.strips.seam_end[static_cast<std::size_t>(end - 1)];
        const auto [reach_begin, reach_end] = reach_.around(first, last);
        step.add(seams_, iteration, begin, end, region)
            .updates(*model_.positions, first, last)
            .reads(*model_.positions, reach_begin, first)
            .reads(*model_.positions, last, reach_end)
            .reads(substep_.targets(), first, last);
    }

    void add_strips(Step& step, int iteration, int begin, int end, int region) {
        const auto [first, last] = substep_.vertices(begin, end);
        auto task = step.add(strips_, iteration, begin, end, region);
        task.updates(*model_.positions, first, last).reads(substep_.targets(), first, last);
        substep_.add_contact_accesses(task, first, last);
    }

    Model& model_;
    DescentSubstep substep_;
    VertexItems items_;
    Slopes slopes_;
    Reach reach_{model_};
    TaskBody predict_, seams_, strips_, velocities_;
};

}  // namespace

std::unique_ptr<Solver> make_vbd_solver(Model& model) { return std::make_unique<VbdSolver>(model); }

}  // namespace weft
