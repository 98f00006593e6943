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
    const Work work{step, plan, frame, samples};
    while (true) {
        if (auto times = try_substeps(work)) return std::move(*times);
        ++redone_;
        live_.go_back_to_start();
    }
}

/// None: they have to be done again. What frames lack that were done again shows in their first
/// substep as a rule, so it is looked at before the others are begun. (Looking more often does not
/// pay: how much room is needed is known when all substeps have run.)
std::optional<RunTimes> FrameRunner::try_substeps(const Work& work) {
    const bool is_doubtful = (redone_ > 0 || was_redone_) && live_.model().scene.substeps > 1;
    RunTimes times;
    if (is_doubtful) {
        times = live_.executor().run(work.step, work.plan, 1);
        if (lacks_room()) return std::nullopt;
    }
    times.append(run_substeps(work, is_doubtful ? 1 : 0));
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
