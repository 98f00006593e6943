// Lets 1000 points fall freely for 8 steps, by weft::runtime and nothing above it: a graph of two
// kernel calls over buffers, planned and run on one CPU core.
#include <cmath>
#include <cstdio>

#include "kernels/motion.h"
#include "runtime/device_list.h"
#include "runtime/executor.h"
#include "scheduler/planner.h"

namespace {

constexpr int kPoints = 1000;
constexpr int kSteps = 8;
constexpr float kStep = 0.125f;  // [s]

/// Both tasks on the only processor, in the order of their dependency.
weft::scheduler::Plan plan_of(const weft::Step& step) {
    weft::scheduler::TaskGraph graph(1);
    const double cost[] = {1.0};
    for (std::size_t i = 0; i < step.tasks().size(); ++i) graph.add_task(cost);
    for (const weft::Dependency& d : step.dependencies()) {
        graph.add_edge(static_cast<weft::scheduler::TaskId>(d.from),
                       static_cast<weft::scheduler::TaskId>(d.to), d.bytes);
    }
    graph.seal();
    weft::scheduler::Plan plan;
    weft::scheduler::make_planner("heft")->plan(graph, plan);
    return plan;
}

}  // namespace

int main() {
    using namespace weft;
    Buffer<float4> positions("positions", kPoints);
    Buffer<float4> previous("previous", kPoints);
    Buffer<float4> velocities("velocities", kPoints);
    Buffer<float4> gravity("gravity", kSteps);
    Buffer<int> begin("begin", 2);
    begin[1] = kPoints;
    for (float4& x : positions.span()) x.w = 1.0f;
    for (float4& g : gravity.span()) g.y = -8.0f;

    const Segments points{&begin, 0, 1, 1};
    const TaskBody fall{"fall",
                        0,
                        {launch(kernels::predict, points, positions, previous, velocities, gravity,
                                kStep, kInstance)}};
    const TaskBody end{"end",
                       1,
                       {launch(kernels::update_velocities, points, positions, previous, velocities,
                               gravity, kStep, 1.0f / kStep, kInstance)}};
    Step step;
    step.add(fall, 0, 0, 1, 0)
        .reads(gravity, 0, kSteps)
        .reads(velocities, 0, kPoints)
        .updates(positions, 0, kPoints)
        .updates(previous, 0, kPoints);
    step.add(end, 0, 0, 1, 0)
        .reads(gravity, 0, kSteps)
        .reads(positions, 0, kPoints)
        .reads(previous, 0, kPoints)
        .updates(velocities, 0, kPoints);
    step.seal();

    const auto devices = open_devices("cpu/1");
    const TaskBody* const bodies[] = {&fall, &end};
    Executor executor({devices.front().get()}, bodies);
    executor.run(step, plan_of(step), kSteps);
    executor.fetch(positions);

    // x = g h^2 (1 + 2 + ... + n), all of it exact in float.
    const float expected = -8.0f * kStep * kStep * (kSteps * (kSteps + 1) / 2);
    std::printf("fell to %g m, expected %g m\n", static_cast<double>(positions[kPoints - 1].y),
                static_cast<double>(expected));
    return positions[kPoints - 1].y == expected ? 0 : 1;
}
