#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/step.h"

namespace weft {

/// How a device reaches the data of buffers.
enum class MemoryModel {
    kHost,      ///< the host's memory and caches: nothing to do
    kMapped,    ///< the host's memory, handed to and fro by map and unmap
    kDiscrete,  ///< its own: ranges are copied
};
std::string_view name_of(MemoryModel memory);

struct DeviceInfo {
    std::string name;
    std::string kind;    ///< "tbb" or "opencl"
    std::string driver;  ///< platform and driver version; empty for TBB
    int units = 1;       ///< threads or compute units in use
    MemoryModel memory = MemoryModel::kHost;
    bool strict = true;  ///< rounds + - * / sqrt correctly, so its results have the same bits
    int lanes = 1;       ///< items per call of a kernel
    std::vector<int> cores = {};  ///< that its threads stay on; empty: they may go anywhere
    /// Devices of one team work at the same time; those of different teams take turns, since they
    /// may have the same cores.
    int team = 0;
};

/// Something submitted to a device that will be done at some time. Owned by its stream, until the
/// stream's next begin().
class Completion {
public:
    virtual ~Completion() = default;
    /// Blocks without spinning. Returns at once if it failed: the stream's finish() tells.
    virtual void wait() = 0;
    /// Calls back once, when done or failed; at once if it already is.
    virtual void when_done(std::function<void()> callback) = 0;
};

/// In seconds of the executor's clock.
struct TimeSpan {
    double start = 0.0;
    double end = 0.0;
};

/// When one task ran, in seconds of the executor's clock.
struct TaskTime {
    int instance = 0;
    int task = 0;
    double start = 0.0;
    double end = 0.0;
};

/// A contiguous part of a buffer, in elements.
struct ElementSpan {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// What a task is submitted with.
struct Submission {
    const Task* task = nullptr;
    int number = 0;                      ///< of the task in its step
    int instance = 0;                    ///< of the step
    std::span<Completion* const> waits;  ///< on other devices; the own stream is in order anyway
};

/// A device's ordered stream of work. One thread submits.
class DeviceStream {
public:
    virtual ~DeviceStream() = default;

    /// Starts a frame: forgets completions and times. `epoch`: steady-clock seconds of time 0.
    virtual void begin(double epoch) = 0;
    /// Between frames: buffers have another size and place than when the bodies were bound to them.
    virtual void rebind() = 0;
    virtual Completion* submit(const Submission& submission) = 0;
    /// Lets everything submitted so far run.
    virtual void flush() = 0;
    /// Waits for everything; throws RunError if the device failed.
    virtual void finish() = 0;
    /// After finish(): when all tasks ran, and all copies in the order in which they were asked
    /// for.
    virtual void times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>& copies) = 0;

    // Only for devices that do not work in the host's memory. Copies run in the order in which they
    // were asked for, from flush() on.
    virtual Completion* to_device(BufferStorage&, ElementSpan,
                                  std::span<Completion* const> waits) = 0;
    virtual Completion* to_host(BufferStorage&, ElementSpan,
                                std::span<Completion* const> waits) = 0;
};

/// One processor that runs kernels.
class Device {
public:
    virtual ~Device() = default;
    virtual const DeviceInfo& info() const = 0;
    /// Builds what these bodies need. The bodies and their buffers must outlive the stream.
    virtual std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) = 0;
};

}  // namespace weft
