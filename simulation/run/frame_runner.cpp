#include "simulation/run/frame_runner.h"

#include <utility>

#include "simulation/checks/error_samples.h"
#include "simulation/contact/response.h"
#include "simulation/run/live_model.h"

namespace weft {

void FrameRunner::begin_frame() {
    was_redone_ = redone_ > 0;
    redone_ = 0;
}

RunTimes FrameRunner::run(const Step& step, const scheduler::Plan& plan, int frame,
                          ErrorSamples* samples) {
    return run({step, plan, frame, samples}, {});
}

std::optional<RunTimes> FrameRunner::run(const FramePlan& plan, int frame, ErrorSamples* samples) {
    auto begun = live_.planned().try_out(plan, live_.model().scene.substeps);
    if (!begun) {
        live_.go_back_to_start();
        return std::nullopt;
    }
    return run({*plan.step, plan.plan, frame, samples}, std::move(*begun));
}

RunTimes FrameRunner::run(const Work& work, PlannedExecutor::Beginning begun) {
    while (true) {
        if (auto times = try_substeps(work, std::move(begun))) return std::move(*times);
        ++redone_;
        live_.go_back_to_start();
        begun = {};
    }
}

/// None: they have to be done again. What frames lack that were done again shows in their first
/// substep as a rule, so it is looked at before the others are begun. (Looking more often does not
/// pay: how much room is needed is known when all substeps have run.)
std::optional<RunTimes> FrameRunner::try_substeps(const Work& work,
                                                  PlannedExecutor::Beginning begun) {
    const bool is_doubtful = (redone_ > 0 || was_redone_) && live_.model().scene.substeps > 1;
    if (is_doubtful && begun.instances == 0) {
        begun = {live_.executor().run(work.step, work.plan, 1), 1};
    }
    if (is_doubtful && lacks_room()) return std::nullopt;
    RunTimes times = std::move(begun.times);
    times.append(run_substeps(work, begun.instances));
    live_.fetch();
    if (lacks_room()) return std::nullopt;
    return times;
}

/// From substep `first` on. Where the last one is wanted, its start is looked at.
RunTimes FrameRunner::run_substeps(const Work& work, int first) {
    const Model& model = live_.model();
    const int last = model.scene.substeps - 1;
    Executor& executor = live_.executor();
    if (work.samples == nullptr || !work.samples->wants(model, work.frame)) {
        if (work.samples != nullptr) work.samples->skip();
        return executor.run(work.step, work.plan, last + 1 - first, first);
    }
    RunTimes times;
    if (last > first) times = executor.run(work.step, work.plan, last - first, first);
    if (last > 0) {
        executor.fetch(*live_.model().positions);
        executor.fetch(*live_.model().velocities);
    }
    work.samples->begin(model, work.frame * model.scene.dt + last * model.h);
    times.append(executor.run(work.step, work.plan, 1, last));
    return times;
}

/// Whether substeps that have run cannot stay as they are; they will find room when they run again.
bool FrameRunner::lacks_room() {
    return live_.planned().make_room() ||
           (live_.contact() != nullptr && live_.contact()->revise(live_.executor()));
}

}  // namespace weft
