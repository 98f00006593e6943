// Whatever the plan and the devices, the result is that of the tasks one after the other.

#include "runtime/executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/device_list.h"
#include "runtime/opencl/opencl_device.h"
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
    {"OpenClPerColour", true,
     [] {
         DeviceOptions options;
         options.per_colour = true;
         options.opencl_lanes = 1;
         return open_devices("opencl:0", options);
     }},
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

TEST_P(ExecutorOn, TimesOfTasksAreOrderedAsTheirDependencies) {
    const Devices devices = GetParam().open();
    std::vector<Device*> pointers;
    for (const auto& device : devices) pointers.push_back(device.get());
    RandomTasks tasks;
    Executor executor(pointers, tasks.bodies());
    Random random(1);
    tasks.fill(random);
    for (BufferStorage* buffer : tasks.buffers()) executor.host_wrote(*buffer);
    const Step step = tasks.make_step(random, 20);
    const auto plan = random_plan(step, static_cast<int>(devices.size()), random);
    const RunTimes times = executor.run(step, plan, RandomTasks::kInstances);

    const std::size_t count = step.tasks().size();
    std::vector<TaskTime> by_task(count * RandomTasks::kInstances);
    for (std::size_t d = 0; d < times.tasks.size(); ++d) {
        for (const TaskTime& time : times.tasks[d]) {
            const auto task = static_cast<std::size_t>(time.task);
            EXPECT_EQ(plan.placements[task].processor, d);
            EXPECT_LE(time.start, time.end);
            by_task[static_cast<std::size_t>(time.instance) * count + task] = time;
        }
    }
    constexpr double kClockError = 100e-6;  // two clocks, read one after the other
    for (const TaskTime& time : by_task) {
        EXPECT_GE(time.start, times.start - kClockError);
        EXPECT_LE(time.end, times.end + kClockError);
    }
    for (const CopyRecord& copy : times.copies) {
        EXPECT_NE(copy.from, copy.to);
        EXPECT_GT(copy.bytes, 0U);
        EXPECT_LE(copy.start, copy.end);
    }
}

std::string name_of_machine(const testing::TestParamInfo<Machine>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Machines, ExecutorOn, testing::ValuesIn(kMachines), name_of_machine);

TEST(Executor, CopiesOnlyWhatIsStale) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    const Devices devices = open_devices("opencl:0", forced(MemoryModel::kDiscrete));
    RandomTasks tasks;
    Executor executor({devices.front().get()}, tasks.bodies());
    Random random(3);
    const Step step = tasks.make_step(random, 20);
    const auto plan = random_plan(step, 1, random);
    EXPECT_TRUE(executor.run(step, plan, RandomTasks::kInstances).copies.empty())
        << "one device has nothing to exchange";
}

}  // namespace
}  // namespace weft::test
