// What the runtime costs per task of a replayed plan, apart from the work: tasks without items on
// one device, and beside it the same number of empty kernels given to the OpenCL driver itself.

#include <benchmark/benchmark.h>

#include <deque>
#include <memory>
#include <optional>

#include "kernels/motion.h"
#include "runtime/device_list.h"
#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/opencl/api.h"

namespace weft {
namespace {

constexpr int kTasks = 100;
constexpr int kInstances = 10;

/// A step of tasks in a row, none of which has anything to do.
class EmptyTasks {
public:
    explicit EmptyTasks(const std::string& device)
        : devices_(open_devices(device)), executor_({devices_.front().get()}, bodies_) {
        for (int t = 0; t < kTasks; ++t) {
            step_.add(body_, 0, {0, 1}).updates(positions_, 0, 1);
            plan_.placements.push_back({static_cast<double>(t), static_cast<double>(t + 1), 0});
        }
        step_.seal();
        plan_.order_by_start(1);
    }

    void run() { executor_.run(step_, plan_, kInstances); }

private:
    Buffer<float4> positions_{"positions", 1}, previous_{"previous", 1},
        velocities_{"velocities", 1}, gravity_{"gravity", kInstances};
    Buffer<int> begin_{"begin", 2};
    const TaskBody body_{"nothing",
                         0,
                         {launch(kernels::predict, Segments{&begin_, 0, 1, 1}, positions_,
                                 previous_, velocities_, gravity_, 0.01f, kInstance)}};
    const std::vector<const TaskBody*> bodies_{&body_};
    std::vector<std::unique_ptr<Device>> devices_;
    Executor executor_;
    Step step_;
    scheduler::Plan plan_;
};

void count_tasks(benchmark::State& state) {
    state.counters["per_task"] =
        benchmark::Counter(kTasks * kInstances, benchmark::Counter::kIsIterationInvariantRate |
                                                    benchmark::Counter::kInvert);
}

void run_empty_tasks(benchmark::State& state, const char* device) {
    std::optional<EmptyTasks> tasks;
    try {
        tasks.emplace(device);
    } catch (const UserError& error) {
        state.SkipWithError(error.what());
        return;
    }
    tasks->run();
    for (auto _ : state) tasks->run();
    count_tasks(state);
}
BENCHMARK_CAPTURE(run_empty_tasks, tbb, "cpu/1")->UseRealTime();
BENCHMARK_CAPTURE(run_empty_tasks, opencl, "opencl:0/1")->UseRealTime();

/// The first OpenCL device, limited to one compute unit if it is the CPU.
cl::Device first_unit() {
    open_devices("opencl:0/1");  // limits a CPU driver's threads, as for run_empty_tasks
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    std::vector<cl::Device> devices;
    platforms.front().getDevices(CL_DEVICE_TYPE_ALL, &devices);
    if ((devices.front().getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) == 0) return devices[0];
    const cl_device_partition_property one[] = {CL_DEVICE_PARTITION_BY_COUNTS, 1,
                                                CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    devices.front().createSubDevices(one, &parts);
    return parts.front();
}

/// With as many arguments as the tasks above: a driver copies them for every command.
constexpr const char* kNothing =
    "__kernel void nothing(__global float4* a, __global float4* b, __global float4* c, "
    "__global float4* d, __global int* e, float f, int g, int h, int i, int j, int k) {}";

/// A queue that lasts as long as the process, as those of streams do (runtime/opencl/stream.cpp):
/// PoCL's workers drop their references to commands, and to what these name, only after clFinish
/// has returned.
struct Queue {
    cl::Context context;
    cl::CommandQueue queue;
    std::vector<cl::Event> events;
    cl::Kernel kernel;
    cl::Buffer memory;
};
Queue& lasting_queue(const cl::Device& device) {
    static auto* all = new std::deque<Queue>;
    const cl::Context context(device);
    cl::Program program(context, kNothing);
    program.build();
    all->push_back({context,
                    cl::CommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE),
                    {},
                    cl::Kernel(program, "nothing"),
                    cl::Buffer(context, CL_MEM_READ_WRITE, 64)});
    return all->back();
}

/// Without the runtime. events: with one per kernel, as profiling needs it.
void enqueue_empty_kernels(benchmark::State& state) {
    cl::Device device;
    try {
        device = first_unit();
    } catch (const UserError& error) {
        state.SkipWithError(error.what());
        return;
    }
    auto& [context, queue, events, kernel, memory] = lasting_queue(device);
    for (cl_uint a = 0; a < 5; ++a) kernel.setArg(a, memory);
    kernel.setArg(5, 0.01f);
    for (cl_uint a = 6; a < 11; ++a) kernel.setArg(a, 0);
    const bool with_events = state.range(0) != 0;
    events.resize(kTasks * kInstances);
    for (auto _ : state) {
        for (int k = 0; k < kTasks * kInstances; ++k) {
            kernel.setArg(6, k);
            queue.enqueueNDRangeKernel(
                kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1), nullptr,
                with_events ? &events[static_cast<std::size_t>(k)] : nullptr);
        }
        queue.finish();
    }
    count_tasks(state);
}
BENCHMARK(enqueue_empty_kernels)->ArgName("events")->Arg(0)->Arg(1)->UseRealTime();

}  // namespace
}  // namespace weft
