#include "runtime/planning/frame_plan.h"

#include <algorithm>
#include <numeric>

namespace weft {

Division FramePlan::division() const {
    Division division{std::vector<int>(graph.processor_count(), 0)};
    for (std::size_t r = 0; r < homes.size(); ++r) {
        division.strips[static_cast<std::size_t>(homes[r])] += parts[r];
    }
    return division;
}

namespace {

/// Exchanges between iterates count in pieces of strips instead.
bool works_on_strips(const Task& task, std::size_t strip_count) {
    return std::ranges::all_of(task.body->launches, [&](const Launch& launch) {
        return static_cast<std::size_t>(launch.segments.strip_count) == strip_count;
    });
}

}  // namespace

std::vector<int> FramePlan::strip_devices() const {
    std::vector<int> devices(
        static_cast<std::size_t>(std::accumulate(parts.begin(), parts.end(), 0)), 0);
    const auto& tasks = step->tasks();
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        if (!works_on_strips(tasks[t], devices.size())) continue;
        for (int s = tasks[t].first_strip; s < tasks[t].end_strip; ++s) {
            devices[static_cast<std::size_t>(s)] = static_cast<int>(plan.placements[t].processor);
        }
    }
    return devices;
}

unsigned FramePlan::devices() const {
    unsigned mask = 0;
    for (const scheduler::Placement& placement : plan.placements) mask |= 1U << placement.processor;
    return mask;
}

}  // namespace weft
