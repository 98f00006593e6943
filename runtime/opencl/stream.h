#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>

#include "runtime/device.h"
#include "runtime/opencl/completion.h"
#include "runtime/opencl/programs.h"

namespace weft {

/// What a stream needs to know of its device.
struct OpenClTarget {
    cl::Context context;
    cl::Device device;
    DeviceInfo info;
    EntryOptions entries;
    std::shared_ptr<Programs> programs;  ///< of all of its streams
    bool is_pocl = false;                ///< whose streams are kept: see stream.cpp
};

/// An in-order queue for tasks, and one beside it for copies.
class OpenClStream final : public DeviceStream {
public:
    OpenClStream(const OpenClTarget& target, std::span<const TaskBody* const> bodies);
    ~OpenClStream() override;

    void begin(double epoch) override;
    void rebind() override;
    Completion* submit(const Submission& submission) override;
    void flush() override;
    void finish() override;
    void times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>& copies) override;
    Completion* to_device(BufferStorage& buffer, ElementSpan span,
                          std::span<Completion* const> waits) override;
    Completion* to_host(BufferStorage& buffer, ElementSpan span,
                        std::span<Completion* const> waits) override;

private:
    /// A kernel with its arguments set, but for the last ones: colour, first strip, instance,
    /// iteration.
    struct Entry {
        cl::Kernel kernel;
        cl_uint dynamic = 0;  ///< index of the first argument that is set per submission
        /// Those arguments as they are set: setting one again costs as much as a short kernel.
        std::array<int, 4> values{-1, -1, -1, -1};

        void set(std::size_t argument, int value);
    };
    struct BoundBody {
        const TaskBody* body = nullptr;
        EntryStyle style = EntryStyle::kPerStrip;
        std::vector<Entry> entries;
    };
    /// The first and the last command of something; `first` is empty where they are the same, since
    /// a second reference to an event is not free.
    struct Commands {
        cl::Event first;
        cl::Event last;
    };
    struct Running : Commands {
        int instance = 0;
        int task = 0;
    };
    /// A buffer as the device has it.
    struct DeviceBuffer {
        std::shared_ptr<const void> home;  ///< which the driver may use in place: goes last
        cl::Buffer buffer;
        int generation = 0;  ///< of the host's
    };
    enum class Direction { kToDevice, kToHost };

    std::size_t group_size() const { return static_cast<std::size_t>(target_.entries.group_size); }
    DeviceBuffer bring(const BufferStorage& buffer);
    const cl::Buffer& memory_of(const BufferStorage& buffer);
    void set_arguments(BoundBody& bound);
    cl_uint set_launch_arguments(cl::Kernel& kernel, cl_uint index, const Launch& launch);
    cl_uint set_segment_arguments(cl::Kernel& kernel, cl_uint index, const Launch& launch);
    void bind(std::span<const TaskBody* const> bodies);
    Completion* submit_once(const Submission& submission, std::vector<cl::Event> waits);
    bool shows_large_groups(const cl::Error& error) const;
    void use_smaller_groups();
    void run_strips(BoundBody& bound, const Submission& s, std::vector<cl::Event>& waits,
                    Running& running);
    void run_colours(BoundBody& bound, const Submission& s, std::vector<cl::Event>& waits,
                     Running& running);
    void run_colour(BoundBody& bound, std::size_t launch, int colour, const Submission& s,
                    std::vector<cl::Event>& waits, Running& running);
    void enqueue(const Entry& entry, const cl::NDRange& items, const cl::NDRange& group,
                 std::vector<cl::Event>& waits, Running& running);
    Completion* copy(Direction direction, BufferStorage& buffer, ElementSpan span,
                     std::span<Completion* const> waits);
    Commands enqueue_copy(Direction direction, BufferStorage& buffer, ElementSpan span,
                          const std::vector<cl::Event>& waits);
    void note_first(const cl::Event& command, double enqueued);
    TimeSpan time_of(const Commands& commands, double offset) const;
    Completion* remember(const cl::Event& event, const cl::CommandQueue& queue);

    OpenClTarget target_;
    cl::CommandQueue queue_;
    cl::CommandQueue copies_;
    PassedOn passed_on_;
    QueueWaits task_waits_, copy_waits_;
    std::map<const BufferStorage*, DeviceBuffer> memory_;
    std::vector<BoundBody> bodies_;
    std::deque<OpenClCompletion> completions_;  ///< numbered in this order
    std::deque<Running> running_;
    std::deque<Commands> copied_;
    double epoch_ = 0.0;
    cl::Event first_command_;      ///< of the frame; a kernel or a copy
    double first_enqueued_ = 0.0;  ///< its steady-clock seconds
};

}  // namespace weft
