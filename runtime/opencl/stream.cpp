#include "runtime/opencl/stream.h"

#include <algorithm>
#include <cstring>
#include <mutex>

#include "runtime/clock.h"
#include "runtime/opencl/memory.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

constexpr double kNanosecond = 1e-9;
constexpr std::size_t kGroup = 64;  // work-items per group where groups mean nothing

/// What must outlive every command.
struct Kept {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue, copies;
    std::vector<cl::Event> events;
};

/// Keeps it until the process ends. PoCL's worker threads (seen with 3.1) drop their reference to a
/// command's event only after clFinish has returned, and crashed in it where the rest was gone.
void keep(Kept kept) {
    static std::mutex mutex;
    static auto* all = new std::vector<Kept>;  // never freed: the workers outlive statics
    const std::lock_guard lock(mutex);
    all->push_back(std::move(kept));
}

/// What the host does with memory while it is mapped.
struct MappedCopy {
    void* to;
    const void* from;
    std::size_t bytes;
    cl::UserEvent done;
};

void CL_CALLBACK copy_mapped(cl_event, cl_int status, void* data) {
    const std::unique_ptr<MappedCopy> copy(static_cast<MappedCopy*>(data));
    if (status == CL_COMPLETE) std::memcpy(copy->to, copy->from, copy->bytes);
    set_status(copy->done, status);
}

}  // namespace

OpenClStream::OpenClStream(const OpenClTarget& target, std::span<const TaskBody* const> bodies)
    : target_(target), passed_on_(target.context) {
    try {
        queue_ = cl::CommandQueue(target.context, target.device, CL_QUEUE_PROFILING_ENABLE);
        copies_ = cl::CommandQueue(target.context, target.device, CL_QUEUE_PROFILING_ENABLE);
        task_waits_ = QueueWaits(queue_());
        copy_waits_ = QueueWaits(copies_());
        bind(bodies);
    } catch (const cl::Error& error) {
        throw opencl_error("preparing " + target_.info.name, error);
    }
}

OpenClStream::~OpenClStream() {
    try {
        copies_.finish();
        queue_.finish();
    } catch (const cl::Error&) {
        // finish() has reported it, or somebody is unwinding from it.
    }
    if (!target_.is_pocl) return;
    Kept kept{target_.device, target_.context, queue_, copies_, {}};
    if (!running_.empty()) kept.events.push_back(running_.back().last);
    if (!copied_.empty()) kept.events.push_back(copied_.back().last);
    keep(std::move(kept));
}

OpenClStream::DeviceBuffer OpenClStream::bring(const BufferStorage& buffer) {
    return {buffer.memory(), make_memory(target_.context, target_.info.memory, buffer),
            buffer.generation()};
}

const cl::Buffer& OpenClStream::memory_of(const BufferStorage& buffer) {
    auto known = memory_.find(&buffer);
    if (known == memory_.end()) known = memory_.emplace(&buffer, bring(buffer)).first;
    WEFT_ASSERT(known->second.generation == buffer.generation());  // else: rebind() first
    return known->second.buffer;
}

cl_uint OpenClStream::set_launch_arguments(cl::Kernel& kernel, cl_uint index,
                                           const Launch& launch) {
    for (std::size_t k = 0; k < launch.arguments.size(); ++k) {
        const Argument& argument = launch.arguments[k];
        if (argument.run_value != RunValue::kNone) continue;
        if (argument.buffer != nullptr)
            kernel.setArg(index++, memory_of(*argument.buffer));
        else if (launch.kernel->parameters[k] == kernels::Parameter::kFloat) {
            kernel.setArg(index++, argument.real);
        } else {
            kernel.setArg(index++, argument.integer);
        }
    }
    return index;
}

cl_uint OpenClStream::set_segment_arguments(cl::Kernel& kernel, cl_uint index,
                                            const Launch& launch) {
    kernel.setArg(index++, memory_of(*launch.segments.begin));
    kernel.setArg(index++, launch.segments.first);
    kernel.setArg(index++, launch.segments.colour_count);
    if (launch.gate != nullptr) kernel.setArg(index++, memory_of(*launch.gate));
    return index;
}

void OpenClStream::bind(std::span<const TaskBody* const> bodies) {
    for (const TaskBody* body : bodies) {
        const EntryPoints points = entry_points(*body, target_.entries);
        const cl::Program& program = target_.programs->program(points);
        BoundBody bound{body, points.style, {}};
        for (const std::string& name : points.names) {
            bound.entries.push_back({cl::Kernel(program, name.c_str())});
        }
        set_arguments(bound);
        bodies_.push_back(std::move(bound));
    }
}

/// One entry has the arguments of all launches, or each launch has its own.
void OpenClStream::set_arguments(BoundBody& bound) {
    for (Entry& entry : bound.entries) entry.dynamic = 0;
    for (std::size_t l = 0; l < bound.body->launches.size(); ++l) {
        const Launch& launch = bound.body->launches[l];
        Entry& entry = bound.entries[std::min(l, bound.entries.size() - 1)];
        entry.dynamic = set_launch_arguments(entry.kernel, entry.dynamic, launch);
        entry.dynamic = set_segment_arguments(entry.kernel, entry.dynamic, launch);
    }
}

/// Rare, so all arguments are set again, whatever has changed.
void OpenClStream::rebind() {
    try {
        for (auto& [buffer, memory] : memory_) {
            if (memory.generation != buffer->generation()) memory = bring(*buffer);
        }
        for (BoundBody& bound : bodies_) set_arguments(bound);
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name + ", taking over buffers of another size", error);
    }
}

void OpenClStream::begin(double epoch) {
    running_.clear();
    copied_.clear();
    completions_.clear();
    passed_on_.clear();
    task_waits_.clear();
    copy_waits_.clear();
    epoch_ = epoch;
    first_command_ = cl::Event();
}

Completion* OpenClStream::remember(const cl::Event& event, const cl::CommandQueue& queue) {
    return &completions_.emplace_back(event, queue(), static_cast<long>(completions_.size()) + 1);
}

Completion* OpenClStream::submit(const Submission& s) {
    try {
        const std::vector<cl::Event> waits = task_waits_.next(s.waits, passed_on_);
        while (true) {
            try {
                return submit_once(s, waits);
            } catch (const cl::Error& error) {
                if (!shows_large_groups(error)) throw;
                use_smaller_groups();
            }
        }
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name + ", task '" + s.task->body->name + "'", error);
    }
}

Completion* OpenClStream::submit_once(const Submission& s, std::vector<cl::Event> waits) {
    const auto bound = std::find_if(bodies_.begin(), bodies_.end(),
                                    [&](const BoundBody& b) { return b.body == s.task->body; });
    if (bound == bodies_.end()) {
        throw Misuse("task body '" + s.task->body->name + "' is not part of this stream");
    }
    Running running;
    running.instance = s.instance;
    running.task = s.number;
    if (bound->style == EntryStyle::kPerColour)
        run_colours(*bound, s, waits, running);
    else
        run_strips(*bound, s, waits, running);
    running_.push_back(std::move(running));
    return remember(running_.back().last, queue_);
}

/// Found out by trying: what drivers say of a kernel (CL_KERNEL_WORK_GROUP_SIZE) is less than what
/// NVIDIA's runs well (docs/measurements.md, "What it taught").
bool OpenClStream::shows_large_groups(const cl::Error& error) const {
    const bool is_possible =
        error.err() == CL_INVALID_WORK_GROUP_SIZE || error.err() == CL_OUT_OF_RESOURCES;
    return is_possible && target_.entries.style == EntryStyle::kPerGroup && group_size() > 1;
}

void OpenClStream::use_smaller_groups() {
    std::vector<const TaskBody*> bodies;
    for (const BoundBody& bound : bodies_) bodies.push_back(bound.body);
    bodies_.clear();
    target_.entries.group_size /= 2;
    bind(bodies);
}

void OpenClStream::Entry::set(std::size_t argument, int value) {
    if (values[argument] == value) return;
    kernel.setArg(dynamic + static_cast<cl_uint>(argument), value);
    values[argument] = value;
}

void OpenClStream::run_strips(BoundBody& bound, const Submission& s, std::vector<cl::Event>& waits,
                              Running& running) {
    Entry& entry = bound.entries.front();
    entry.set(0, s.task->first_strip);
    entry.set(1, s.instance);
    entry.set(2, s.task->iteration);
    WEFT_ASSERT(s.task->first_strip < s.task->end_strip);
    const auto strips = static_cast<std::size_t>(s.task->end_strip - s.task->first_strip);
    const std::size_t group = bound.style == EntryStyle::kPerStrip ? 1 : group_size();
    enqueue(entry, cl::NDRange(strips * group), cl::NDRange(group), waits, running);
}

void OpenClStream::run_colours(BoundBody& bound, const Submission& s, std::vector<cl::Event>& waits,
                               Running& running) {
    for (Entry& entry : bound.entries) {
        entry.set(1, s.task->first_strip);
        entry.set(2, s.instance);
        entry.set(3, s.task->iteration);
    }
    const auto colours = [&](std::size_t l) {
        return bound.body->launches[l].segments.colour_count;
    };
    const auto turns = static_cast<std::size_t>(bound.body->taking_turns);
    for (int colour = 0; turns > 0 && colour < colours(0); ++colour) {
        for (std::size_t l = 0; l < turns; ++l) run_colour(bound, l, colour, s, waits, running);
    }
    for (std::size_t l = turns; l < bound.entries.size(); ++l) {
        for (int colour = 0; colour < colours(l); ++colour) {
            run_colour(bound, l, colour, s, waits, running);
        }
    }
    if (running.last() == nullptr) {  // no items at all
        const double enqueued = now();
        queue_.enqueueMarkerWithWaitList(&waits, &running.last);
        note_first(running.last, enqueued);
    }
}

void OpenClStream::run_colour(BoundBody& bound, std::size_t launch, int colour, const Submission& s,
                              std::vector<cl::Event>& waits, Running& running) {
    Entry& entry = bound.entries[launch];
    const Segments& segments = bound.body->launches[launch].segments;
    const int most = segments.largest(colour, s.task->first_strip, s.task->end_strip);
    if (most == 0) return;
    entry.set(0, colour);
    const auto lanes = static_cast<std::size_t>(target_.info.lanes);
    const auto strips = static_cast<std::size_t>(s.task->end_strip - s.task->first_strip);
    const std::size_t items = (static_cast<std::size_t>(most) + lanes - 1) / lanes;
    const cl::NDRange range((items + kGroup - 1) / kGroup * kGroup, strips);
    enqueue(entry, range, cl::NDRange(kGroup, 1), waits, running);
    waits.clear();  // the queue is in order: the first command's waits serve for all
}

void OpenClStream::enqueue(const Entry& entry, const cl::NDRange& items, const cl::NDRange& group,
                           std::vector<cl::Event>& waits, Running& running) {
    const double enqueued = now();
    if (running.first() == nullptr) running.first = std::move(running.last);
    queue_.enqueueNDRangeKernel(entry.kernel, cl::NullRange, items, group,
                                waits.empty() ? nullptr : &waits, &running.last);
    note_first(running.last, enqueued);
}

void OpenClStream::note_first(const cl::Event& command, double enqueued) {
    if (first_command_() != nullptr) return;
    first_command_ = command;
    first_enqueued_ = enqueued;
}

void OpenClStream::flush() {
    try {
        queue_.flush();
        copies_.flush();  // which wait for tasks
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name, error);
    }
}

TimeSpan OpenClStream::time_of(const Commands& commands, double offset) const {
    const cl::Event& first = commands.first() != nullptr ? commands.first : commands.last;
    const auto start = first.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = commands.last.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return {static_cast<double>(start) * kNanosecond + offset,
            static_cast<double>(end) * kNanosecond + offset};
}

void OpenClStream::finish() {
    try {
        copies_.finish();
        queue_.finish();
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name, error);
    }
}

void OpenClStream::times(std::vector<TaskTime>& tasks, std::vector<TimeSpan>& copies) {
    try {
        if (first_command_() == nullptr) return;
        // Both clocks were read within a microsecond of each other when the first command was
        // enqueued; so their difference is known anew every frame, and cannot drift.
        const auto queued = first_command_.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>();
        const double offset = first_enqueued_ - epoch_ - static_cast<double>(queued) * kNanosecond;
        for (const Running& r : running_) {
            const TimeSpan time = time_of(r, offset);
            tasks.push_back({r.instance, r.task, time.start, time.end});
        }
        for (const Commands& c : copied_) copies.push_back(time_of(c, offset));
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name, error);
    }
}

OpenClStream::Commands OpenClStream::enqueue_copy(Direction direction, BufferStorage& buffer,
                                                  ElementSpan span,
                                                  const std::vector<cl::Event>& waits) {
    WEFT_ASSERT(span.begin < span.end && span.end <= buffer.count());
    const cl::Buffer& memory = memory_of(buffer);
    const std::size_t offset = span.begin * buffer.element_size();
    const std::size_t bytes = (span.end - span.begin) * buffer.element_size();
    char* host = static_cast<char*>(buffer.host()) + offset;
    const bool out = direction == Direction::kToDevice;
    const auto* wait_list = waits.empty() ? nullptr : &waits;
    const double enqueued = now();
    Commands commands;
    if (target_.info.memory == MemoryModel::kMapped) {
        void* mapped = copies_.enqueueMapBuffer(memory, CL_FALSE,
                                                out ? CL_MAP_WRITE_INVALIDATE_REGION : CL_MAP_READ,
                                                offset, bytes, wait_list, &commands.first);
        const cl::UserEvent done(target_.context);
        auto copy = std::make_unique<MappedCopy>(out ? MappedCopy{mapped, host, bytes, done}
                                                     : MappedCopy{host, mapped, bytes, done});
        commands.first.setCallback(CL_COMPLETE, copy_mapped, copy.get());
        static_cast<void>(copy.release());  // copy_mapped owns it now
        const std::vector<cl::Event> copied{done};
        copies_.enqueueUnmapMemObject(memory, mapped, &copied, &commands.last);
        note_first(commands.first, enqueued);
        return commands;
    }
    if (out) {
        copies_.enqueueWriteBuffer(memory, CL_FALSE, offset, bytes, host, wait_list,
                                   &commands.last);
    } else {
        copies_.enqueueReadBuffer(memory, CL_FALSE, offset, bytes, host, wait_list, &commands.last);
    }
    note_first(commands.last, enqueued);
    return commands;
}

Completion* OpenClStream::copy(Direction direction, BufferStorage& buffer, ElementSpan span,
                               std::span<Completion* const> waits) {
    try {
        copied_.push_back(
            enqueue_copy(direction, buffer, span, copy_waits_.next(waits, passed_on_)));
        return remember(copied_.back().last, copies_);
    } catch (const cl::Error& error) {
        throw opencl_error(target_.info.name + ", copying '" + buffer.name() + "'", error);
    }
}

Completion* OpenClStream::to_device(BufferStorage& buffer, ElementSpan span,
                                    std::span<Completion* const> waits) {
    return copy(Direction::kToDevice, buffer, span, waits);
}

Completion* OpenClStream::to_host(BufferStorage& buffer, ElementSpan span,
                                  std::span<Completion* const> waits) {
    return copy(Direction::kToHost, buffer, span, waits);
}

}  // namespace weft
