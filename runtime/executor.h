#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/device.h"
#include "runtime/error.h"
#include "runtime/memory_map.h"
#include "scheduler/plan.h"

namespace weft {

/// One copy between two memories, made for the task that reads the data.
struct CopyRecord {
    int instance = 0;
    int task = 0;
    int from = 0;  ///< devices
    int to = 0;
    std::uint64_t bytes = 0;
    double start = 0.0;
    double end = 0.0;
};

/// What one run of a plan did; times in seconds of the executor's clock.
struct RunTimes {
    double start = 0.0;
    double end = 0.0;
    std::vector<std::vector<TaskTime>> tasks;  ///< [device]
    std::vector<CopyRecord> copies;

    /// What ran next; or first, where nothing has.
    void append(RunTimes next);
};

/// A device by its number in an executor. The run counts all that there ever were.
enum class ActiveDevice : int {};

/// A device failed for good; the others have ended what they had to do.
class DeviceLost : public RunError {
public:
    DeviceLost(ActiveDevice lost, const std::string& what) : RunError(what), device(lost) {}

    const ActiveDevice device;
};

/// Runs plans: every device works through its part of the tasks, as Plan::order has them, as soon
/// as what they depend on is done. Nothing spins. Everything is submitted ahead, so that devices
/// wait for each other only, never for the host.
class Executor {
public:
    /// bodies  all that steps may use. Devices, bodies and their buffers must outlive the executor.
    Executor(std::vector<Device*> devices, std::span<const TaskBody* const> bodies);
    /// With the clock of an executor that this one takes over from.
    Executor(std::vector<Device*> devices, std::span<const TaskBody* const> bodies, double epoch);
    ~Executor();

    /// Runs the step `instances` times in a row by one plan (processors are the devices, in order)
    /// and waits for the end. Instances are numbered from first_instance. Throws DeviceLost when a
    /// device fails; Misuse for a step that is not sealed, a plan that is not of it and of these
    /// devices, more instances than a buffer has rows for, and a buffer that is there no more.
    RunTimes run(const Step& step, const scheduler::Plan& plan, int instances,
                 int first_instance = 0);

    /// To be called after buffers have been resized: from now on devices work on what these are
    /// now. Their contents are the host's. Throws DeviceLost.
    void rebind(std::span<BufferStorage* const> buffers);
    /// To be called after the host has written into a buffer that devices have. Throws DeviceLost,
    /// as does fetch().
    void host_wrote(BufferStorage& buffer);
    /// Makes the host's copy of a buffer current, for data that steps wrote.
    void fetch(BufferStorage& buffer);

    /// Seconds since the epoch: since the executor was made, or the first of a row of them.
    double clock() const;
    double epoch() const { return epoch_; }  ///< in steady-clock seconds

private:
    class Run;
    struct UsedBuffer {
        std::string name;
        std::shared_ptr<const bool> alive;
    };
    void note_buffers(std::span<const TaskBody* const> bodies);
    void check(const Step& step, const scheduler::Plan& plan, int instances,
               int first_instance) const;
    /// Calls on a device's stream; what it throws becomes DeviceLost.
    template <class Call>
    void on(std::size_t device, Call call);
    template <class DeviceOf, class Call>
    void guard(DeviceOf device_of, Call call);
    std::size_t find_submitter(const scheduler::Plan& plan) const;
    void drain();

    std::vector<Device*> devices_;
    std::vector<std::unique_ptr<DeviceStream>> streams_;
    std::vector<UsedBuffer> buffers_;  ///< that the bodies work on
    MemoryMap memory_;
    bool one_memory_ = true;  ///< all devices work in the host's: nothing to copy, nothing to track
    double epoch_;
};

}  // namespace weft
