#include "tests/runtime/planning/virtual_machine.h"

#include <algorithm>

#include "runtime/submission_order.h"
#include "runtime/tbb/cpu_device.h"

namespace weft::test {

VirtualMachine::VirtualMachine(std::vector<Speed> given, double given_latency,
                               const std::vector<int>& teams)
    : speeds(std::move(given)), latency(given_latency), asleep_(speeds.size(), true) {
    for (std::size_t d = 0; d < speeds.size(); ++d) {
        const int team = teams.empty() ? 0 : teams[d];
        devices_.push_back(make_cpu_device(team == 0 ? 1 : 2, {}, 0, team));
    }
}

std::vector<Device*> VirtualMachine::devices() const {
    std::vector<Device*> list;
    for (const auto& device : devices_) list.push_back(device.get());
    return list;
}

RunTimes VirtualMachine::run(const FramePlan& plan, int instances) {
    const auto& tasks = plan.step->tasks();
    const auto& placements = plan.plan.placements;
    const std::vector<int> order = submission_order(*plan.step, plan.plan);

    RunTimes times;
    times.start = clock_;
    times.tasks.resize(speeds.size());
    std::vector<double> free(speeds.size(), clock_);
    std::vector<double> previous(tasks.size(), clock_ - 1.0);
    for (int instance = 0; instance < instances; ++instance) {
        std::vector<double> end(tasks.size());
        for (const int task : order) {
            const auto t = static_cast<std::size_t>(task);
            const std::size_t device = placements[t].processor;
            const double drowsy = asleep_[device] ? speeds[device].waking : 1.0;
            double start = free[device];
            const auto wait = [&](const Dependency& d, const std::vector<double>& ends) {
                if (d.to != task) return;
                const auto from = static_cast<std::size_t>(d.from);
                const bool same = placements[from].processor == device;
                start = std::max(start, ends[from] + (same ? 0.0 : drowsy * latency));
            };
            for (const Dependency& d : plan.step->dependencies()) wait(d, end);
            for (const Dependency& d : plan.step->carried()) wait(d, previous);
            end[t] = free[device] = start + drowsy * speeds[device](tasks[t]);
            times.tasks[device].push_back({instance, task, start, end[t]});
        }
        previous = end;
    }
    for (std::size_t d = 0; d < speeds.size(); ++d) asleep_[d] = times.tasks[d].empty();
    clock_ = times.end = *std::max_element(free.begin(), free.end());
    clock_ += 1e-3;
    return times;
}

}  // namespace weft::test
