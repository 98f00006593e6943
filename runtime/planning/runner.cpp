#include "runtime/planning/runner.h"

#include <cstring>
#include <optional>
#include <set>

#include "runtime/error.h"
#include "runtime/io/word_hash.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/planning/planned_executor.h"
#include "runtime/planning/recorded_plans.h"
#include "runtime/planning/work_checks.h"
#include "runtime/trace/host_info.h"
#include "runtime/trace/trace_writer.h"

namespace weft {

namespace {

/// What the work says it carries, or else all that its steps write, in the order of its tasks; but
/// for tables, which every step fills anew.
std::vector<BufferStorage*> carried_by(Work& work) {
    std::vector<BufferStorage*> list = work.carried();
    if (!list.empty()) return list;
    std::set<BufferStorage*> seen;
    for (RowTable* table : work.tables()) {
        for (BufferStorage* column : table->resized_buffers()) seen.insert(column);
    }
    const Step step = work.make_step(Partition::whole(work.strip_count()));
    for (const Task& task : step.tasks()) {
        for (const Access& access : task.accesses) {
            if (access.writes && seen.insert(access.buffer).second) list.push_back(access.buffer);
        }
    }
    return list;
}

/// Copies of buffers' contents.
class Contents {
public:
    void take(const std::vector<BufferStorage*>& buffers) {
        bytes_.resize(buffers.size());
        for (std::size_t b = 0; b < buffers.size(); ++b) {
            const auto* begin = static_cast<const std::byte*>(buffers[b]->host());
            bytes_[b].assign(begin, begin + buffers[b]->bytes());
        }
    }
    void put(const std::vector<BufferStorage*>& buffers) const {
        for (std::size_t b = 0; b < buffers.size(); ++b) {
            std::memcpy(buffers[b]->host(), bytes_[b].data(), bytes_[b].size());
        }
    }

private:
    std::vector<std::vector<std::byte>> bytes_;
};

DeviceDescription describe_device(const DeviceInfo& info) {
    return {info.name,
            info.kind,
            info.driver,
            static_cast<std::uint32_t>(info.units),
            std::string(name_of(info.memory)),
            info.strict,
            static_cast<std::uint32_t>(info.team)};
}

}  // namespace

class Runner::Impl {
public:
    Impl(Work& work, std::vector<std::unique_ptr<Device>> devices, const RunnerOptions& options)
        : work_(work), options_(options) {
        check_work(work, devices.size());
        carried_ = carried_by(work);
        known_.emplace(work);
        run_.emplace(work, work.strip_count(), std::move(devices),
                     PlanningOptions{options.plan, std::nullopt, options.cost_file,
                                     options.device_options.strict_math});
        warnings_ = opencl_troubles();
        start_.take(carried_);
        if (options.calibrate > 0) calibrate();
        if (!options.trace.empty()) trace_.emplace(options.trace, describe());
    }

    FrameRecord advance(int instances) {
        FrameRecord frame = begin(instances);
        while (!run_planned(instances, frame)) {
        }
        end_part(frame, frame.learn_time);
        if (trace_) trace_->append(frame);
        ++frame_;
        return frame;
    }

    void replay(const RunDescription& run, const FrameRecord& frame) {
        if (frame.substeps < 1) refuse_replay(frame.frame, "its instances were not recorded");
        known_->check();
        RecordedPlans plans(
            run, work_.strip_count(),
            [&](const Division& division) {
                return work_.make_step(division.partition().spread(work_.iterate_count()));
            },
            [&](const Task& task) { return run_->planner().timing().items_vary(task); });
        const auto [step, plan] = plans.plan_of(frame, run_->devices().size());
        start_.take(carried_);
        execute(*step, plan, static_cast<int>(frame.substeps));
        ++frame_;
    }

    void wrote(BufferStorage& buffer) { run_->executor().host_wrote(buffer); }
    void fetch(BufferStorage& buffer) { run_->executor().fetch(buffer); }

    std::string state_hash() const {
        WordHash hash;
        for (const BufferStorage* buffer : carried_) {
            const auto* words = static_cast<const std::uint32_t*>(buffer->host());
            for (std::size_t w = 0; w < buffer->bytes() / sizeof(std::uint32_t); ++w) {
                hash.add(words[w]);
            }
        }
        return hash.text();
    }

    void finish() {
        if (trace_) trace_->finish(state_hash());
        trace_.reset();
        is_finished_ = true;
        run_->save_costs(frame_);
    }

    RunDescription describe() const {
        RunDescription run;
        run.scene_name = options_.name;
        run.host = host_info();
        run.versions = runtime_versions();
        run.settings = {{"strips", std::to_string(work_.strip_count())}};
        for (const auto& device : run_->devices()) {
            run.devices.push_back(describe_device(device->info()));
            if (device->info().memory != MemoryModel::kHost && run_->devices().size() > 1)
                run.has_transfers = true;
        }
        run.kinds = work_.kinds();
        return run;
    }

    const PlannedExecutor& run() const { return *run_; }
    const std::vector<std::string>& warnings() const { return warnings_; }
    int frame() const { return frame_; }

private:
    /// Again with those that are left, if a device is lost meanwhile.
    void calibrate() {
        while (true) {
            try {
                const bool known = run_->restore_costs();
                return run_->calibrate(
                    options_.calibrate, known, [&] { undo(); }, warnings_);
            } catch (const DeviceLost& lost) {
                go_on_without(lost);
            }
        }
    }

    void go_on_without(const DeviceLost& lost) {
        start_.put(carried_);
        run_->go_on_without(lost, frame_);
        warnings_.push_back("device " + std::to_string(run_->losses().back().device) +
                            " was lost in frame " + std::to_string(frame_) +
                            ", which was done again without it: " + lost.what());
    }

    FrameRecord begin(int instances) {
        if (instances < 1) {
            throw Misuse("a frame is at least one instance of the step, not " +
                         std::to_string(instances));
        }
        if (is_finished_) throw Misuse("the run was finished: there are no frames behind finish()");
        known_->check();
        FrameRecord frame;
        frame.frame = static_cast<std::uint32_t>(frame_);
        frame.substeps = static_cast<std::uint32_t>(instances);
        frame.start = frame.end = run_->executor().clock();
        start_.take(carried_);
        end_part(frame, frame.place_time);
        return frame;
    }

    /// False: a device was lost, or the plan was a mistake, and the frame has to be done again.
    bool run_planned(int instances, FrameRecord& frame) {
        try {
            run_->make_room_ahead();
            const FramePlan& plan = run_->next();
            end_part(frame, frame.plan_time);
            auto beginning = run_->try_out(plan, instances);
            if (!beginning) undo();
            end_part(frame, frame.execute_time);
            if (!beginning) return false;
            const RunTimes times = execute(*plan.step, plan.plan, instances, std::move(*beginning));
            end_part(frame, frame.execute_time);
            run_->record(plan, times, instances, trace_.has_value(), frame);
            run_->learn(plan, times, instances, frame_);
            return true;
        } catch (const DeviceLost& lost) {
            go_on_without(lost);
            end_part(frame, frame.execute_time);
            return false;
        }
    }

    /// begun  what was run of the frame already
    RunTimes execute(const Step& step, const scheduler::Plan& plan, int instances,
                     PlannedExecutor::Beginning begun = {}) {
        while (true) {
            RunTimes times = std::move(begun.times);
            times.append(
                run_->executor().run(step, plan, instances - begun.instances, begun.instances));
            for (BufferStorage* buffer : carried_) run_->executor().fetch(*buffer);
            if (!run_->make_room()) return times;
            undo();
            begun = {};
        }
    }

    void undo() {
        start_.put(carried_);
        for (BufferStorage* buffer : carried_) run_->executor().host_wrote(*buffer);
    }

    /// What has passed since the last part ended belongs to this one.
    void end_part(FrameRecord& frame, double& part) const {
        const double time = run_->executor().clock();
        part += time - frame.end;
        frame.end = time;
    }

    Work& work_;
    RunnerOptions options_;
    std::vector<BufferStorage*> carried_;
    std::optional<KnownBuffers> known_;
    std::optional<PlannedExecutor> run_;
    std::optional<TraceWriter> trace_;
    std::vector<std::string> warnings_;
    Contents start_;  ///< of what is carried, when the frame at hand began
    int frame_ = 0;
    bool is_finished_ = false;
};

Runner::Runner(Work& work, const RunnerOptions& options)
    : Runner(work, Devices{open_devices(options.devices, options.device_options)}, options) {}

Runner::Runner(Work& work, Devices devices, const RunnerOptions& options)
    : impl_(std::make_unique<Impl>(work, std::move(devices.list), options)) {}

Runner::~Runner() = default;

FrameRecord Runner::advance(int instances) { return impl_->advance(instances); }
void Runner::replay(const RunDescription& run, const FrameRecord& frame) {
    impl_->replay(run, frame);
}
void Runner::wrote(BufferStorage& buffer) { impl_->wrote(buffer); }
void Runner::fetch(BufferStorage& buffer) { impl_->fetch(buffer); }
std::string Runner::state_hash() const { return impl_->state_hash(); }
void Runner::finish() { impl_->finish(); }
int Runner::frame() const { return impl_->frame(); }
const std::vector<std::string>& Runner::warnings() const { return impl_->warnings(); }
const std::vector<std::unique_ptr<Device>>& Runner::devices() const {
    return impl_->run().devices();
}
RunDescription Runner::describe() const { return impl_->describe(); }

std::vector<int> Runner::lost_devices() const {
    std::vector<int> numbers;
    for (const LostDevice& lost : impl_->run().losses()) numbers.push_back(lost.device);
    return numbers;
}

}  // namespace weft
