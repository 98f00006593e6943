#include "runtime/executor.h"

#include <algorithm>
#include <set>

#include "runtime/clock.h"
#include "runtime/cores.h"
#include "runtime/submission_order.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

std::string number(std::size_t count, const char* what) {
    return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// Every task must be in its device's row, once.
void refuse_other_plan(const Step& step, const scheduler::Plan& plan, std::size_t devices) {
    const std::size_t tasks = step.tasks().size();
    const auto refuse = [](const std::string& why) {
        throw Misuse("the plan is not of this step: " + why);
    };
    if (plan.placements.size() != tasks || plan.order.size() != tasks) {
        refuse("it has " + number(plan.placements.size(), "task") + ", and the step has " +
               std::to_string(tasks));
    }
    if (plan.order_begin.size() != devices + 1) {
        refuse("it is for " +
               number(std::max<std::size_t>(plan.order_begin.size(), 1) - 1, "device") +
               ", and there are " + std::to_string(devices));
    }
    for (std::size_t d = 0; d < devices; ++d) {
        for (const scheduler::TaskId task : plan.tasks_on(static_cast<scheduler::ProcessorId>(d))) {
            if (task >= tasks) refuse("it names task " + std::to_string(task));
            if (plan.placements[task].processor != d) {
                refuse("task " + std::to_string(task) + " is in the row of device " +
                       std::to_string(d) + ", and placed on device " +
                       std::to_string(plan.placements[task].processor));
            }
        }
    }
}

void refuse_more_instances(const Step& step, int instances) {
    for (const auto& [buffer, per_instance] : step.instance_limits()) {
        const std::size_t most = buffer->count() / static_cast<std::size_t>(per_instance);
        if (static_cast<std::size_t>(instances) <= most) continue;
        throw Misuse("buffer '" + buffer->name() + "' has rows for " + number(most, "instance") +
                     ", and the step is to be run for " + std::to_string(instances));
    }
}

}  // namespace

/// The submission of one run.
class Executor::Run {
public:
    Run(Executor& executor, const Step& step, const scheduler::Plan& plan)
        : executor_(executor),
          step_(step),
          plan_(plan),
          order_(submission_order(step, plan)),
          hop_count_(executor.devices_.size(), 0) {
        previous_.resize(order_.size(), nullptr);
        current_.resize(order_.size(), nullptr);
        group(step.dependencies(), within_);
        group(step.carried(), carried_);
    }

    /// The device that was last called.
    int at() const { return at_; }

    void submit(int instance) {
        std::swap(previous_, current_);
        for (const int task : order_) submit(instance, task);
    }

    /// The copies, with the times that the streams measured. [device][hop]
    std::vector<CopyRecord> copies(const std::vector<std::vector<TimeSpan>>& times) const {
        std::vector<CopyRecord> records;
        for (const Copy& copy : copies_) {
            const auto time = [&](const std::pair<int, std::size_t>& hop) {
                return times[static_cast<std::size_t>(hop.first)][hop.second];
            };
            CopyRecord& record = records.emplace_back(copy.record);
            record.start = time(copy.hops.front()).start;
            // Two devices' clocks agree to a microsecond or two, and a copy can be as short.
            record.end = std::max(record.start, time(copy.hops.back()).end);
        }
        return records;
    }

private:
    struct Copy {
        CopyRecord record;
        std::vector<std::pair<int, std::size_t>> hops;  ///< device, number of the copy there
    };

    const scheduler::Placement& placement(int task) const {
        return plan_.placements[static_cast<std::size_t>(task)];
    }
    int device_of(int task) const { return static_cast<int>(placement(task).processor); }
    /// The memory that a device works in.
    MemoryId memory_of(int device) const {
        const auto model = executor_.devices_[static_cast<std::size_t>(device)]->info().memory;
        return model == MemoryModel::kHost ? MemoryId::host() : MemoryId::of_device(device);
    }
    DeviceStream& stream(int device) {
        at_ = device;
        return *executor_.streams_[static_cast<std::size_t>(device)];
    }

    void group(const std::vector<Dependency>& dependencies,
               std::vector<std::vector<int>>& by_task) {
        by_task.resize(order_.size());
        for (const Dependency& d : dependencies) {
            if (device_of(d.from) == device_of(d.to)) continue;  // the streams are in order
            by_task[static_cast<std::size_t>(d.to)].push_back(d.from);
        }
    }

    void submit(int instance, int number) {
        const Task& task = step_.tasks()[static_cast<std::size_t>(number)];
        const int device = device_of(number);
        waits_.clear();
        for (const int from : within_[static_cast<std::size_t>(number)]) add_wait(current_, from);
        for (const int from : carried_[static_cast<std::size_t>(number)]) add_wait(previous_, from);
        if (!executor_.one_memory_) bring_all(task, device, instance, number);

        WEFT_ASSERT(std::ranges::find(waits_, nullptr) == waits_.end());
        Completion* done = stream(device).submit({&task, number, instance, waits_});
        current_[static_cast<std::size_t>(number)] = done;
        if (executor_.one_memory_) return;
        for (const Access& access : task.accesses) {
            if (access.writes) executor_.memory_.written(access, memory_of(device), done);
        }
    }

    void add_wait(const std::vector<Completion*>& completions, int task) {
        if (Completion* wait = completions[static_cast<std::size_t>(task)]) waits_.push_back(wait);
    }

    void bring_all(const Task& task, int device, int instance, int number) {
        const std::size_t known = copies_.size();
        for (const Access& access : task.accesses) bring(access, device, instance, number);
        let_copies_run(known);
        for (const Access& access : task.accesses) {
            for (Completion* c : executor_.memory_.arrivals(access, memory_of(device))) {
                waits_.push_back(c);
            }
        }
    }

    /// Copies what the device does not have yet, through the host where it must.
    void bring(const Access& access, int device, int instance, int task) {
        const MemoryId memory = memory_of(device);
        for (const auto& missing : executor_.memory_.missing(access, memory)) {
            const ElementSpan span = elements_of(access, missing.interval);
            if (span.begin == span.end) continue;  // strips without an element
            const std::uint64_t bytes = (span.end - span.begin) * access.buffer->element_size();
            WEFT_ASSERT(missing.source != memory);
            const int from = missing.source.is_host() ? host_device() : missing.source.device();
            Copy copy{{instance, task, from, device, bytes}, {}};
            std::vector<Completion*> after = missing.made_by;
            if (!missing.source.is_host()) {
                after = {move(access, missing.interval, span, from, MemoryId::host(), after, copy)};
            }
            if (!memory.is_host())
                move(access, missing.interval, span, device, memory, after, copy);
            copies_.push_back(std::move(copy));
        }
    }

    /// One hop between the host's memory and that of `owner`, to `memory`.
    Completion* move(const Access& access, Interval interval, const ElementSpan& span, int owner,
                     MemoryId memory, std::span<Completion* const> after, Copy& copy) {
        WEFT_ASSERT(!memory_of(owner).is_host());
        DeviceStream& s = stream(owner);
        Completion* arrival = memory.is_host() ? s.to_host(*access.buffer, span, after)
                                               : s.to_device(*access.buffer, span, after);
        executor_.memory_.arrived(access, interval, memory, arrival);
        copy.hops.emplace_back(owner, hop_count_[static_cast<std::size_t>(owner)]++);
        return arrival;
    }

    /// From number `first` on.
    void let_copies_run(std::size_t first) {
        std::set<int> owners;
        for (std::size_t c = first; c < copies_.size(); ++c) {
            for (const auto& hop : copies_[c].hops) owners.insert(hop.first);
        }
        for (const int owner : owners) stream(owner).flush();
    }

    /// The device that works in the host's memory.
    int host_device() const {
        int device = 0;
        while (!memory_of(device).is_host()) ++device;
        return device;
    }

    Executor& executor_;
    const Step& step_;
    const scheduler::Plan& plan_;
    std::vector<int> order_;
    std::vector<std::vector<int>> within_, carried_;  ///< [task] tasks on other devices to wait for
    std::vector<Completion*> previous_, current_;     ///< [task] of the last and of this instance
    std::vector<Completion*> waits_;
    std::vector<Copy> copies_;
    std::vector<std::size_t> hop_count_;  ///< [device]
    int at_ = 0;
};

Executor::Executor(std::vector<Device*> devices, std::span<const TaskBody* const> bodies)
    : Executor(std::move(devices), bodies, now()) {}

Executor::Executor(std::vector<Device*> devices, std::span<const TaskBody* const> bodies,
                   double epoch)
    : devices_(std::move(devices)), epoch_(epoch) {
    if (devices_.empty()) throw Misuse("an executor needs at least one device");
    note_buffers(bodies);
    for (Device* device : devices_) {
        streams_.push_back(device->open_stream(bodies));
        one_memory_ = one_memory_ && device->info().memory == MemoryModel::kHost;
    }
}

Executor::~Executor() = default;

void Executor::note_buffers(std::span<const TaskBody* const> bodies) {
    std::set<const BufferStorage*> seen;
    const auto note = [&](const BufferStorage* buffer) {
        if (buffer == nullptr || !seen.insert(buffer).second) return;
        buffers_.push_back({buffer->name(), buffer->alive()});
    };
    for (const TaskBody* body : bodies) {
        for (const Launch& launch : body->launches) {
            note(launch.segments.begin);
            note(launch.gate);
            for (const Argument& argument : launch.arguments) note(argument.buffer);
        }
    }
}

void Executor::check(const Step& step, const scheduler::Plan& plan, int instances,
                     int first_instance) const {
    if (!step.sealed()) throw Misuse("the step is not sealed: call seal() when all tasks are in");
    if (instances < 1 || first_instance < 0) {
        throw Misuse("a step is run for at least one instance, from 0 on; not for " +
                     std::to_string(instances) + " from " + std::to_string(first_instance));
    }
    refuse_other_plan(step, plan, devices_.size());
    for (const UsedBuffer& buffer : buffers_) {
        if (!*buffer.alive) {
            throw Misuse("buffer '" + buffer.name +
                         "' is there no more: it must outlive what "
                         "runs on it");
        }
    }
    refuse_more_instances(step, first_instance + instances);
}

double Executor::clock() const { return now() - epoch_; }

/// The first device of the plan that stays on its cores, or the last of all.
std::size_t Executor::find_submitter(const scheduler::Plan& plan) const {
    for (std::size_t d = 0; d < devices_.size(); ++d) {
        const bool works = !plan.tasks_on(static_cast<scheduler::ProcessorId>(d)).empty();
        if (works && !devices_[d]->info().cores.empty()) return d;
    }
    return devices_.size() - 1;
}

void RunTimes::append(RunTimes next) {
    if (tasks.empty()) {
        *this = std::move(next);
        return;
    }
    end = next.end;
    for (std::size_t d = 0; d < tasks.size(); ++d) {
        tasks[d].insert(tasks[d].end(), next.tasks[d].begin(), next.tasks[d].end());
    }
    copies.insert(copies.end(), next.copies.begin(), next.copies.end());
}

RunTimes Executor::run(const Step& step, const scheduler::Plan& plan, int instances,
                       int first_instance) {
    check(step, plan, instances, first_instance);
    for (const auto& stream : streams_) stream->begin(epoch_);
    memory_.settle();
    // Submitting disturbs the devices that stay on their cores; it shall not wander among them.
    const std::size_t submitter = find_submitter(plan);
    const PinnedThread pinned(devices_[submitter]->info().cores);

    RunTimes times;
    times.start = clock();
    Run run(*this, step, plan);
    std::vector<std::vector<TimeSpan>> copy_times(streams_.size());
    for (int i = 0; i < instances; ++i) {
        guard([&] { return run.at(); }, [&] { run.submit(first_instance + i); });
        // Last the one whose core submits: it takes that core.
        for (std::size_t d = 0; d < streams_.size(); ++d) {
            if (d != submitter) on(d, [&] { streams_[d]->flush(); });
        }
        on(submitter, [&] { streams_[submitter]->flush(); });
    }
    for (std::size_t d = 0; d < streams_.size(); ++d) {
        on(d, [&] { streams_[d]->finish(); });
    }
    times.end = clock();
    times.tasks.resize(streams_.size());
    for (std::size_t d = 0; d < streams_.size(); ++d) {
        on(d, [&] { streams_[d]->times(times.tasks[d], copy_times[d]); });
    }
    times.copies = run.copies(copy_times);
    return times;
}

template <class Call>
void Executor::on(std::size_t device, Call call) {
    guard([&] { return static_cast<int>(device); }, call);
}

/// Whatever fails, the streams are left idle. device_of(): the one that is lost by an error of its
/// own.
template <class DeviceOf, class Call>
void Executor::guard(DeviceOf device_of, Call call) {
    try {
        call();
    } catch (const RunError& error) {
        drain();
        throw DeviceLost(ActiveDevice{device_of()}, error.what());
    } catch (...) {
        drain();
        throw;
    }
}

/// After a failure: streams wait for each other's completions, so all have to end before one goes.
void Executor::drain() {
    const auto each = [&](auto call) {
        for (const auto& stream : streams_) {
            try {
                call(*stream);
            } catch (const std::exception&) {
                // The first error is the one to report.
            }
        }
    };
    each([](DeviceStream& stream) { stream.flush(); });
    each([](DeviceStream& stream) { stream.finish(); });
}

void Executor::rebind(std::span<BufferStorage* const> buffers) {
    for (const BufferStorage* buffer : buffers) memory_.forget(*buffer);
    for (std::size_t d = 0; d < streams_.size(); ++d) {
        on(d, [&] { streams_[d]->rebind(); });
    }
}

void Executor::host_wrote(BufferStorage& buffer) {
    memory_.forget(buffer);
    const ElementSpan whole{0, buffer.count()};
    for (std::size_t d = 0; d < devices_.size(); ++d) {
        if (devices_[d]->info().memory == MemoryModel::kHost) continue;
        on(d, [&] { streams_[d]->to_device(buffer, whole, {})->wait(); });
    }
}

void Executor::fetch(BufferStorage& buffer) {
    memory_.settle();
    for (const auto& [access, missing] : memory_.missing_at_host(buffer)) {
        const ElementSpan span = elements_of(access, missing.interval);
        if (span.begin == span.end) continue;
        const auto source = static_cast<std::size_t>(missing.source.device());
        on(source, [&] { streams_[source]->to_host(buffer, span, {})->wait(); });
        memory_.arrived(access, missing.interval, MemoryId::host(), nullptr);
    }
}

}  // namespace weft
