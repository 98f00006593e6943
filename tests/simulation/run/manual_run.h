#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/executor.h"
#include "runtime/planning/division.h"
#include "simulation/model/model.h"
#include "simulation/solver/solver.h"

namespace weft::test {

/// A scene on given devices by given divisions, without any planner: every device takes its strips,
/// in the order of the tasks. The state is open to the test.
class ManualRun {
public:
    ManualRun(const Scene& scene, std::vector<std::unique_ptr<Device>> devices);
    /// On one thread of the CPU.
    explicit ManualRun(const Scene& scene);

    int strip_count() const { return model->strips.count(); }
    int device_count() const { return static_cast<int>(devices_.size()); }

    /// Back to the scene's beginning.
    void reset();
    /// Simulates frames, or, with `substeps`, only so many substeps of one frame.
    void run(int frames, const Division& division);
    void run(int frames) { run(frames, Division::single(device_count(), strip_count(), 0)); }
    void run_substeps(int substeps);

    /// To be called after writing to the model's buffers.
    void changed(BufferStorage& buffer) { executor_->host_wrote(buffer); }

    /// xyz of a buffer in scene order.
    std::vector<float> in_scene_order(const Buffer<float4>& buffer) const;
    std::string hash() const;

    std::unique_ptr<Model> model;
    std::unique_ptr<Solver> solver;
    /// Frames that ran again because bodies went where contact had not foreseen it.
    int unforeseen = 0;

private:
    void run_frame(const Division& division, int substeps);
    void run_step(const Division& division, int substeps);
    bool revises_contact();
    void hand_over_placed();
    std::vector<BufferStorage*> state();

    std::vector<std::unique_ptr<Device>> devices_;
    std::unique_ptr<Executor> executor_;
    std::vector<float4> first_positions_, first_velocities_;
    int frame_ = 0;
};

/// The tasks of a step on the devices of its regions, in their own order.
scheduler::Plan plan_in_order(const Step& step, const Division& division);

}  // namespace weft::test
