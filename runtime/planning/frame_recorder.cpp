#include "runtime/planning/frame_recorder.h"

namespace weft {

namespace {

std::uint32_t u32(int value) { return static_cast<std::uint32_t>(value); }

std::uint32_t number_of(const std::vector<int>& numbers, int device) {
    return u32(numbers[static_cast<std::size_t>(device)]);
}

}  // namespace

void FrameRecorder::sum_up(const FramePlan& plan, const RunTimes& times, int substeps,
                           const std::vector<int>& numbers, FrameRecord& frame) const {
    frame.planned_makespan = plan.substep_time() * substeps;
    frame.measured_makespan = times.end - times.start;
    frame.lower_bound = plan.lower_bound() * substeps;
    frame.pace = plan.slowdown;
    frame.busy.assign(devices_, 0.0);
    for (std::size_t d = 0; d < times.tasks.size(); ++d) {
        double& busy = frame.busy[static_cast<std::size_t>(numbers[d])];
        for (const TaskTime& t : times.tasks[d]) busy += t.end - t.start;
    }
    for (const CopyRecord& copy : times.copies) frame.transferred_bytes += copy.bytes;
}

void FrameRecorder::list(const FramePlan& plan, const RunTimes& times, const TimingModel& timing,
                         const std::vector<int>& numbers, FrameRecord& frame) {
    plans_.record(plan, timing, numbers, frame);
    const auto& tasks = plan.step->tasks();
    for (std::size_t d = 0; d < times.tasks.size(); ++d) {
        for (const TaskTime& t : times.tasks[d]) {
            const auto items =
                static_cast<std::uint64_t>(timing.items(tasks[static_cast<std::size_t>(t.task)]));
            frame.executions.push_back(
                {u32(t.instance), u32(t.task), u32(numbers[d]), items, t.start, t.end});
        }
    }
    for (const CopyRecord& copy : times.copies) {
        frame.transfers.push_back({u32(copy.instance), u32(copy.task),
                                   number_of(numbers, copy.from), number_of(numbers, copy.to),
                                   copy.bytes, copy.start, copy.end});
    }
}

}  // namespace weft
