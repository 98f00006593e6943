// Whatever the plan and the devices, the result is that of the tasks one after the other.

#include "runtime/executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "runtime/device_list.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/submission_order.h"
#include "runtime/tbb/cpu_device.h"
#include "tests/runtime/random_tasks.h"

namespace weft::test {
namespace {

using Devices = std::vector<std::unique_ptr<Device>>;

struct Machine {
    std::string name;
    bool needs_opencl;
    Devices (*open)();
};

DeviceOptions forced(MemoryModel memory) {
    DeviceOptions options;
    options.memory = memory;
    return options;
}

Devices one_as_gpus_run_it(EntryStyle style, int group_size = 16) {
    DeviceOptions options;
    options.entry_style = style;
    options.group_size = group_size;
    options.opencl_lanes = 1;
    return open_devices("opencl:0", options);
}

void append(Devices& devices, Devices more) {
    for (auto& device : more) devices.push_back(std::move(device));
}

Devices three_devices() {
    Devices devices;
    devices.push_back(make_cpu_device(1, {}));
    append(devices, open_opencl_device(0, {}, forced(MemoryModel::kDiscrete)));
    append(devices, open_opencl_device(0, {}, forced(MemoryModel::kMapped)));
    return devices;
}

Devices four_devices() {
    Devices devices = open_opencl_device(0, {}, forced(MemoryModel::kDiscrete));
    append(devices, open_opencl_device(0, {}, forced(MemoryModel::kDiscrete)));
    devices.push_back(make_cpu_device(2, {}, 1));
    devices.push_back(make_cpu_device(1, {}));
    return devices;
}

const Machine kMachines[] = {
    {"OneThread", false, [] { return open_devices("cpu/1"); }},
    {"TwoThreads", false,
     [] {
         Devices devices;
         devices.push_back(make_cpu_device(2, {}));
         return devices;
     }},
    {"ThreeCpuDevices", false,
     [] {
         Devices devices;
         for (int i = 0; i < 3; ++i) devices.push_back(make_cpu_device(1, {}));
         return devices;
     }},
    {"Hybrid", true, [] { return open_devices("cpu/1+opencl:0/1"); }},
    {"HybridDiscrete", true,
     [] { return open_devices("cpu/1+opencl:0/1", forced(MemoryModel::kDiscrete)); }},
    {"HybridMapped", true,
     [] { return open_devices("cpu/1+opencl:0/1", forced(MemoryModel::kMapped)); }},
    {"OpenClAlone", true, [] { return open_devices("opencl:0"); }},
    {"OpenClPerColour", true, [] { return one_as_gpus_run_it(EntryStyle::kPerColour); }},
    {"OpenClPerGroup", true, [] { return one_as_gpus_run_it(EntryStyle::kPerGroup); }},
    {"OpenClInTooLargeGroups", true,
     [] { return one_as_gpus_run_it(EntryStyle::kPerGroup, 1 << 14); }},
    {"OpenClAloneDiscrete", true,
     [] { return open_devices("opencl:0", forced(MemoryModel::kDiscrete)); }},
    {"ThreeDevices", true, three_devices},
    {"FourDevices", true, four_devices},
};

class ExecutorOn : public testing::TestWithParam<Machine> {
protected:
    void SetUp() override {
        if (GetParam().needs_opencl && opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device";
    }
};

TEST_P(ExecutorOn, RandomPlansOfRandomGraphsEndAsTheSerialRun) {
    const Devices devices = GetParam().open();
    std::vector<Device*> pointers;
    for (const auto& device : devices) pointers.push_back(device.get());
    RandomTasks tasks;
    RandomTasks reference;
    Executor executor(pointers, tasks.bodies());

    for (unsigned seed = 0; seed < 60; ++seed) {
        Random values(seed);
        Random same_values(seed);
        tasks.fill(values);
        reference.fill(same_values);
        for (BufferStorage* buffer : tasks.buffers()) executor.host_wrote(*buffer);

        // Two runs in a row: what the first left on the devices is where the second starts.
        for (const unsigned round : {0U, 1U}) {
            Random random(2 * seed + round);
            Random same(2 * seed + round);
            const Step step = tasks.make_step(random, 1 + static_cast<int>(seed % 25));
            const auto plan = random_plan(step, static_cast<int>(devices.size()), random);
            const RunTimes times = executor.run(step, plan, RandomTasks::kInstances);
            reference.run_serially(reference.make_step(same, 1 + static_cast<int>(seed % 25)));

            std::size_t executed = 0;
            for (const auto& device : times.tasks) executed += device.size();
            EXPECT_EQ(executed, step.tasks().size() * RandomTasks::kInstances);
        }
        for (BufferStorage* buffer : tasks.buffers()) executor.fetch(*buffer);
        const auto state = tasks.state();
        ASSERT_TRUE(
            std::all_of(state.begin(), state.end(), [](float v) { return std::isfinite(v); }));
        ASSERT_EQ(state, reference.state()) << "seed " << seed;
    }
}

/// By how much a task began before one that it waits for had ended, at most [s].
struct Overtaking {
    double on_one_device = -1.0;
    double between_devices = -1.0;
};

Overtaking overtaking(const Step& step, const scheduler::Plan& plan,
                      const std::vector<TaskTime>& by_task) {
    const std::size_t count = step.tasks().size();
    Overtaking most;
    const auto look = [&](const Dependency& d, std::size_t from_instance, std::size_t to_instance) {
        const auto from = static_cast<std::size_t>(d.from);
        const auto to = static_cast<std::size_t>(d.to);
        const double early =
            by_task[from_instance * count + from].end - by_task[to_instance * count + to].start;
        const bool same = plan.placements[from].processor == plan.placements[to].processor;
        double& worst = same ? most.on_one_device : most.between_devices;
        worst = std::max(worst, early);
    };
    for (std::size_t i = 0; i < RandomTasks::kInstances; ++i) {
        for (const Dependency& d : step.dependencies()) look(d, i, i);
        if (i == 0) continue;
        for (const Dependency& d : step.carried()) look(d, i - 1, i);
    }
    return most;
}

/// The times of all tasks, [instance * tasks + task], after checks of each by itself.
std::vector<TaskTime> times_by_task(const RunTimes& times, const scheduler::Plan& plan) {
    const std::size_t count = plan.placements.size();
    std::vector<TaskTime> by_task(count * RandomTasks::kInstances);
    for (std::size_t d = 0; d < times.tasks.size(); ++d) {
        for (const TaskTime& time : times.tasks[d]) {
            const auto task = static_cast<std::size_t>(time.task);
            EXPECT_EQ(plan.placements[task].processor, d);
            EXPECT_LE(time.start, time.end);
            by_task[static_cast<std::size_t>(time.instance) * count + task] = time;
        }
    }
    for (const CopyRecord& copy : times.copies) {
        EXPECT_NE(copy.from, copy.to);
        EXPECT_GT(copy.bytes, 0U);
        EXPECT_LE(copy.start, copy.end);
    }
    return by_task;
}

/// Clocks of two devices are read one after the other, and now and then something else gets the
/// core between the two: one of a few runs has to be free of that.
TEST_P(ExecutorOn, TimesOfTasksAreOrderedAsTheirDependencies) {
    constexpr double kClockError = 100e-6;
    constexpr double kTick = 1e-6;
    const Devices devices = GetParam().open();
    std::vector<Device*> pointers;
    for (const auto& device : devices) pointers.push_back(device.get());
    RandomTasks tasks;
    Executor executor(pointers, tasks.bodies());
    Random random(1);
    tasks.fill(random);
    for (BufferStorage* buffer : tasks.buffers()) executor.host_wrote(*buffer);
    const Step step = tasks.make_step(random, 20);
    ASSERT_FALSE(step.dependencies().empty());
    ASSERT_FALSE(step.carried().empty());
    const auto plan = random_plan(step, static_cast<int>(devices.size()), random);

    double between_devices = 1.0;
    double outside = 1.0;
    for (int run = 0; run < 8; ++run) {
        const RunTimes times = executor.run(step, plan, RandomTasks::kInstances);
        const auto by_task = times_by_task(times, plan);
        const Overtaking most = overtaking(step, plan, by_task);
        EXPECT_LE(most.on_one_device, kTick) << "a device has one clock and one queue";
        between_devices = std::min(between_devices, most.between_devices);
        double worst = 0.0;
        for (const TaskTime& time : by_task) {
            worst = std::max({worst, times.start - time.start, time.end - times.end});
        }
        outside = std::min(outside, worst);
    }
    EXPECT_LE(between_devices, kClockError);
    EXPECT_LE(outside, kClockError) << "the run's own times";
}

std::string name_of_machine(const testing::TestParamInfo<Machine>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Machines, ExecutorOn, testing::ValuesIn(kMachines), name_of_machine);

/// Which memory has which element, noted one by one.
class Ledger {
public:
    explicit Ledger(const Devices& devices) {
        for (std::size_t d = 0; d < devices.size(); ++d) {
            const bool host = devices[d]->info().memory == MemoryModel::kHost;
            memory_.push_back(host ? 0 : d + 1);
        }
    }

    /// Bytes that have to come before the step's tasks can run, in the order of the plan.
    std::uint64_t bytes_of(const Step& step, const scheduler::Plan& plan) {
        std::vector<std::size_t> order(step.tasks().size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return plan.placements[a].start < plan.placements[b].start;
        });
        std::uint64_t bytes = 0;
        for (const std::size_t t : order) {
            const std::size_t memory = memory_[plan.placements[t].processor];
            for (const Access& access : step.tasks()[t].accesses) bytes += bring(access, memory);
            for (const Access& access : step.tasks()[t].accesses) {
                if (!access.writes) continue;
                for_each(access, [&](std::set<std::size_t>& stale) {
                    for (std::size_t m = 0; m <= memory_.size(); ++m) stale.insert(m);
                    stale.erase(memory);
                });
            }
        }
        return bytes;
    }

private:
    template <class Call>
    void for_each(const Access& access, Call call) {
        const ElementSpan span = elements_of(access, {access.begin, access.end});
        for (std::size_t e = span.begin; e < span.end; ++e) call(stale_[{access.buffer, e}]);
    }

    std::uint64_t bring(const Access& access, std::size_t memory) {
        std::uint64_t bytes = 0;
        for_each(access, [&](std::set<std::size_t>& stale) {
            if (stale.erase(memory) == 0) return;
            stale.erase(0);  // copies go through the host
            bytes += access.buffer->element_size();
        });
        return bytes;
    }

    std::vector<std::size_t> memory_;  ///< [device] 0: the host's
    std::map<std::pair<const BufferStorage*, std::size_t>, std::set<std::size_t>> stale_;
};

class Copies : public testing::TestWithParam<Devices (*)()> {};

TEST_P(Copies, CopiesOnlyWhatIsStale) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    const Devices devices = GetParam()();
    std::vector<Device*> pointers;
    for (const auto& device : devices) pointers.push_back(device.get());
    RandomTasks tasks;
    Executor executor(pointers, tasks.bodies());
    Ledger ledger(devices);
    std::uint64_t all = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {  // one goes on where the last one ended
        Random random(seed);
        const Step step = tasks.make_step(random, 10);
        const auto plan = random_plan(step, static_cast<int>(devices.size()), random);
        std::uint64_t expected = 0;
        for (int i = 0; i < RandomTasks::kInstances; ++i) expected += ledger.bytes_of(step, plan);
        std::uint64_t copied = 0;
        for (const CopyRecord& copy : executor.run(step, plan, RandomTasks::kInstances).copies) {
            copied += copy.bytes;
        }
        EXPECT_EQ(copied, expected) << "seed " << seed;
        all += copied;
    }
    EXPECT_EQ(all == 0, devices.size() == 1) << "one device has nothing to exchange";
}

Devices one_discrete() { return open_devices("opencl:0", forced(MemoryModel::kDiscrete)); }
Devices host_and_discrete() {
    return open_devices("cpu/1+opencl:0/1", forced(MemoryModel::kDiscrete));
}

INSTANTIATE_TEST_SUITE_P(Machines, Copies,
                         testing::Values(&one_discrete, &host_and_discrete, &four_devices));

TEST(SubmissionOrder, KeepsEachDevicesOrderAndWhatTasksWaitFor) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        RandomTasks tasks;
        const Step step = tasks.make_step(random, 25);
        scheduler::Plan plan = random_plan(step, 3, random);
        // The order counts, not the forecast.
        for (scheduler::Placement& placement : plan.placements) placement.start = 0.0;
        const std::vector<int> order = submission_order(step, plan);
        ASSERT_EQ(order.size(), step.tasks().size());
        std::vector<std::size_t> place(order.size());
        for (std::size_t i = 0; i < order.size(); ++i)
            place[static_cast<std::size_t>(order[i])] = i;
        for (const Dependency& d : step.dependencies()) {
            EXPECT_LT(place[static_cast<std::size_t>(d.from)],
                      place[static_cast<std::size_t>(d.to)]);
        }
        for (scheduler::ProcessorId p = 0; p < 3; ++p) {
            const auto row = plan.tasks_on(p);
            for (std::size_t i = 1; i < row.size(); ++i)
                EXPECT_LT(place[row[i - 1]], place[row[i]]);
        }
    }
}

}  // namespace
}  // namespace weft::test
