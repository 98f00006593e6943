#pragma once

#include <memory>
#include <vector>

#include "runtime/step.h"
#include "scheduler/plan.h"
#include "tests/kernels/random.h"

namespace weft::test {

/// Task bodies over a few shared buffers, whose results depend on the order of the tasks.
class RandomTasks {
public:
    static constexpr int kInstances = 3;

    RandomTasks();
    ~RandomTasks();

    /// New values in all buffers.
    void fill(Random& random);
    /// So many tasks on random ranges of strips.
    Step make_step(Random& random, int task_count);

    std::vector<const TaskBody*> bodies() const;
    std::vector<BufferStorage*> buffers();
    /// All bits of all buffers.
    std::vector<float> state();

    /// Runs the tasks one after the other, by the scalar kernels, without any executor.
    void run_serially(const Step& step);

private:
    struct Body;
    void add_bodies();
    static void run_serially(const Task& task, int strip, int instance);

    static constexpr int kStrips = 8;
    static constexpr int kPoints = 4;  ///< buffers of points

    Buffer<int> strip_begin_, spring_begin_;
    Segments strips_, springs_;
    std::vector<std::unique_ptr<Buffer<float4>>> points_;
    Buffer<float4> gravity_;
    Buffer<int> ends_;
    Buffer<float> material_, multipliers_;
    Buffer<int> gate_;  ///< [strips] 0: a launch passes over it
    std::vector<std::unique_ptr<Body>> bodies_;
};

/// A random plan: any device for any task, in any order that respects the dependencies.
scheduler::Plan random_plan(const Step& step, int device_count, Random& random);

}  // namespace weft::test
