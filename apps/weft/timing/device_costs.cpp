#include "apps/weft/timing/device_costs.h"

#include <algorithm>
#include <functional>

#include "kernels/motion.h"
#include "runtime/clock.h"
#include "runtime/executor.h"
#include "scheduler/order_statistics.h"

namespace weft {

namespace {

constexpr int kRounds = 15;
constexpr int kBatch = 200;
constexpr std::size_t kTinyItems = 8;
constexpr std::size_t kLargeItems = std::size_t{1} << 20;  // 16 MiB

/// Of several runs, the first of which pages in and is not counted.
std::vector<double> times_of(int rounds, const std::function<void()>& action) {
    std::vector<double> times;
    action();
    for (int round = 0; round < rounds; ++round) {
        const double start = now();
        action();
        times.push_back(now() - start);
    }
    return times;
}

/// What others do on the machine only adds to it.
double least_time(int rounds, const std::function<void()>& action) {
    return std::ranges::min(times_of(rounds, action));
}

double median_time(int rounds, const std::function<void()>& action) {
    std::vector<double> times = times_of(rounds, action);
    return scheduler::middle_of(times);
}

/// The cheapest kernel of all, over a handful of vertices in buffers of any size.
struct Probe {
    explicit Probe(std::size_t count)
        : positions("positions", count),
          previous("previous", count),
          velocities("velocities", count),
          gravity("gravity", 1),
          begin("segments", 2) {
        begin[1] = static_cast<int>(kTinyItems);
        body.launches.push_back(launch(kernels::predict, Segments{&begin, 0, 1, 1}, positions,
                                       previous, velocities, gravity, 0.0f, 0));
    }

    Buffer<float4> positions, previous, velocities, gravity;
    Buffer<int> begin;
    TaskBody body{"probe", 0, {}};
};

void measure_launches(Device& device, DeviceCosts& costs) {
    Probe probe(kTinyItems);
    const TaskBody* const bodies[] = {&probe.body};
    Executor executor({&device}, bodies);
    Step step;
    step.add(probe.body, 0, {0, 1});
    step.seal();
    scheduler::Plan plan;
    plan.placements.push_back({0.0, 1.0, 0});
    plan.order_by_start(1);
    costs.batch = least_time(kRounds, [&] { executor.run(step, plan, 1); });
    const double all = least_time(kRounds, [&] { executor.run(step, plan, kBatch); });
    costs.launch = std::max(0.0, all - costs.batch) / (kBatch - 1);
}

TransferCost measure_copies(const std::function<void(std::size_t elements)>& copy) {
    const double tiny = median_time(kRounds, [&] { copy(1); });
    const double large = median_time(kRounds, [&] { copy(kLargeItems); });
    const double bytes = static_cast<double>((kLargeItems - 1) * sizeof(float4));
    return {tiny, bytes / std::max(large - tiny, 1e-9)};
}

void measure_transfers(Device& device, DeviceCosts& costs) {
    Probe probe(kLargeItems);
    const TaskBody* const bodies[] = {&probe.body};
    const auto stream = device.open_stream(bodies);
    stream->begin(now());
    costs.to_device = measure_copies([&](std::size_t elements) {
        stream->to_device(probe.positions, {0, elements}, {})->wait();
    });
    costs.to_host = measure_copies([&](std::size_t elements) {
        stream->to_host(probe.positions, {0, elements}, {})->wait();
    });
}

}  // namespace

DeviceCosts measure_costs(Device& device) {
    DeviceCosts costs;
    measure_launches(device, costs);
    if (device.info().memory != MemoryModel::kHost) measure_transfers(device, costs);
    return costs;
}

}  // namespace weft
