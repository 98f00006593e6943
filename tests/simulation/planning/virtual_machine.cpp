#include "tests/simulation/planning/virtual_machine.h"

#include <algorithm>
#include <numeric>

#include "runtime/tbb/cpu_device.h"

namespace weft::test {

VirtualMachine::VirtualMachine(std::vector<Speed> given, double given_latency)
    : speeds(std::move(given)), latency(given_latency) {
    for (std::size_t d = 0; d < speeds.size(); ++d) devices_.push_back(make_cpu_device(1, {}));
}

std::vector<Device*> VirtualMachine::devices() const {
    std::vector<Device*> list;
    for (const auto& device : devices_) list.push_back(device.get());
    return list;
}

RunTimes VirtualMachine::run(const FramePlan& plan, int instances) {
    const auto& tasks = plan.step->tasks();
    const auto& placements = plan.plan.placements;
    std::vector<std::size_t> order(tasks.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return placements[a].start < placements[b].start;
    });

    RunTimes times;
    times.start = clock_;
    times.tasks.resize(speeds.size());
    std::vector<double> free(speeds.size(), clock_);
    std::vector<double> previous(tasks.size(), clock_ - 1.0);
    for (int instance = 0; instance < instances; ++instance) {
        std::vector<double> end(tasks.size());
        for (const std::size_t t : order) {
            const std::size_t device = placements[t].processor;
            double start = free[device];
            const auto wait = [&](const Dependency& d, const std::vector<double>& ends) {
                if (d.to != static_cast<int>(t)) return;
                const auto from = static_cast<std::size_t>(d.from);
                const bool same = placements[from].processor == device;
                start = std::max(start, ends[from] + (same ? 0.0 : latency));
            };
            for (const Dependency& d : plan.step->dependencies()) wait(d, end);
            for (const Dependency& d : plan.step->carried()) wait(d, previous);
            const Speed& speed = speeds[device];
            end[t] = free[device] =
                start + speed.fixed + speed.per_item * static_cast<double>(tasks[t].items);
            times.tasks[device].push_back({instance, static_cast<int>(t), start, end[t]});
        }
        previous = end;
    }
    clock_ = times.end = *std::max_element(free.begin(), free.end());
    clock_ += 1e-3;
    return times;
}

}  // namespace weft::test
