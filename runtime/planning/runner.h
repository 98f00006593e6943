#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/device_list.h"
#include "runtime/planning/plan_kind.h"
#include "runtime/planning/work.h"
#include "runtime/trace/records.h"

namespace weft {

struct RunnerOptions {
    std::string devices = "hybrid";  ///< as open_devices() knows them
    DeviceOptions device_options = {};
    PlanKind plan = PlanKind::kAuto;
    /// Instances that each device runs at the start to be known; they are taken back. 0: none, and
    /// the first frames' plans are guesses.
    int calibrate = 2;
    std::filesystem::path cost_file = {};  ///< where costs are kept between runs; empty: nowhere
    std::filesystem::path trace = {};      ///< an HDF5 file of all that happens; empty: none
    std::string name = "run";              ///< for the trace
};

/// Devices that the caller has opened, or made. A type of its own, so that two options in braces
/// are never taken for a list of devices.
struct Devices {
    Devices(std::vector<std::unique_ptr<Device>> opened) : list(std::move(opened)) {}
    std::vector<std::unique_ptr<Device>> list;
};

/// Runs work on devices, frame by frame: plans each frame from costs that it learns while running,
/// executes it, and writes a trace. Results do not depend on devices or plans. If a device fails,
/// the frame is done again from its start on the others.
///
///     weft::Runner runner(work, {.devices = "cpu/1+opencl:0/1"});
///     for (int frame = 0; frame < 100; ++frame) runner.advance(20);
///     runner.finish();
///
/// The work and its buffers must outlive the runner. Between frames buffers belong to the host:
/// those that the work carries are current then; wrote() tells that the host has written into one.
class Runner {
public:
    /// Throws UserError for devices that cannot be had, Misuse for work that makes no step, whose
    /// tasks do not say what their kernels read and write, or whose buffers are gone.
    explicit Runner(Work& work, const RunnerOptions& options = {});
    /// options.devices is not used.
    Runner(Work& work, Devices devices, const RunnerOptions& options = {});
    ~Runner();
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;

    /// Runs the step so many times in a row, by one plan. Instances are numbered from 0. Gives how
    /// long it was planned to take, and took; with options.trace also each task (plan, executions),
    /// which replay() needs. Throws Misuse for fewer than one, behind finish(), and if a buffer was
    /// resized or a strip table changed since the runner was made; RunError if the last device is
    /// lost.
    FrameRecord advance(int instances);
    /// Runs a recorded frame again: every task on the recorded device, in the recorded order. Where
    /// the runner has fewer devices than the trace, they do the others' tasks: the same bits.
    /// Nothing is planned, learnt or traced. run, frame: of a TraceReader (run(), frame(i), which
    /// has the plan; frames() has not). Throws UserError if the frame is of other work.
    void replay(const RunDescription& run, const FrameRecord& frame);

    /// To be called after the host has written into a buffer.
    void wrote(BufferStorage& buffer);
    /// Makes the host's copy of a buffer current that the work does not carry.
    void fetch(BufferStorage& buffer);
    /// 32 hex digits over all bits of what the work carries: equal states have equal hashes.
    std::string state_hash() const;

    /// Marks the trace as finished, and keeps the costs. Called by nobody else: a run that ends by
    /// an exception leaves an unfinished trace.
    void finish();

    int frame() const;  ///< the next one
    /// What devices said and did that is no error; the numbers of those that were lost.
    const std::vector<std::string>& warnings() const;
    std::vector<int> lost_devices() const;
    const std::vector<std::unique_ptr<Device>>& devices() const;
    /// For traces: everything that is known before the first frame.
    RunDescription describe() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace weft
