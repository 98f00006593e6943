#include "runtime/planning/planned_executor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/planning/saved_costs.h"

namespace weft {

namespace {

std::vector<int> numbers_below(std::size_t count) {
    std::vector<int> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

void grow(RowTable& table, std::span<const float> unseen, Executor& executor) {
    table.grow(unseen);
    executor.rebind(table.resized_buffers());
    for (BufferStorage* buffer : table.written_buffers()) executor.host_wrote(*buffer);
}

}  // namespace

PlannedExecutor::PlannedExecutor(StepMaker& maker, int strip_count,
                                 std::vector<std::unique_ptr<Device>> devices,
                                 PlanningOptions options)
    : maker_(&maker),
      strip_count_(strip_count),
      devices_(std::move(devices)),
      options_(std::move(options)),
      active_(numbers_below(devices_.size())),
      recorder_(devices_.size()) {
    open();
}

std::vector<Device*> PlannedExecutor::active_devices() const {
    std::vector<Device*> list;
    for (const int number : active_)
        list.push_back(devices_[static_cast<std::size_t>(number)].get());
    return list;
}

/// An executor and a planner for the devices that are there.
void PlannedExecutor::open() {
    const auto bodies = maker_->bodies();
    const double epoch = executor_ ? executor_->epoch() : now();
    executor_.reset();
    executor_ = std::make_unique<Executor>(active_devices(), bodies, epoch);
    planner_ = std::make_unique<FramePlanner>(*maker_, strip_count_, active_devices(),
                                              options_.plan, fixed_division());
}

std::optional<Division> PlannedExecutor::fixed_division() const {
    const bool all = active_.size() == devices_.size();
    if (all && options_.division) return options_.division;
    if (options_.plan != PlanKind::kAsync) return std::nullopt;
    return division_by_units();
}

Division PlannedExecutor::division_by_units() const {
    const auto devices = active_devices();
    std::vector<double> units;
    for (const Device* device : devices) {
        const DeviceInfo& info = device->info();
        if (info.team == devices.front()->info().team) units.push_back(info.units);
    }
    Division division = Division::proportional(strip_count_, units);
    division.strips.resize(devices.size(), 0);
    return division;
}

void PlannedExecutor::take_over(StepMaker& maker, int strip_count) {
    const TimingModel learnt = planner_->timing();
    maker_ = &maker;
    strip_count_ = strip_count;
    open();
    planner_->timing().inherit(learnt, numbers_below(active_.size()));
    planner_->balance_mixture();
}

void PlannedExecutor::take_over(StepMaker& maker, int strip_count, PlanKind plan) {
    options_.plan = plan;
    take_over(maker, strip_count);
}

void PlannedExecutor::go_on_without(const DeviceLost& lost, int frame) {
    const auto place = active_.begin() + static_cast<int>(lost.device);
    const int number = *place;
    losses_.push_back({number, frame, lost.what()});
    active_.erase(place);
    if (active_.empty()) {
        throw RunError("device " + devices_[static_cast<std::size_t>(number)]->info().name +
                       " was lost in frame " + std::to_string(frame) +
                       ", and there is no other: " + lost.what());
    }
    std::vector<int> kept = numbers_below(active_.size());
    for (int& k : kept) k += k >= static_cast<int>(lost.device) ? 1 : 0;
    const TimingModel learnt = planner_->timing();
    open();
    planner_->timing().inherit(learnt, kept);
    planner_->balance_mixture();
}

bool PlannedExecutor::restore_costs() {
    if (options_.cost_file.empty()) return false;
    const SavedCosts saved(options_.cost_file);
    if (!saved.restore(maker_->bodies(), active_devices(), options_.strict_math,
                       planner_->timing())) {
        return false;
    }
    planner_->balance_mixture();
    return true;
}

void PlannedExecutor::save_costs(int frames) {
    constexpr int kEnoughFrames = 5;  // the first ones are no rule
    if (options_.cost_file.empty() || frames < kEnoughFrames) return;
    look_at_load(frames);
    // Later frames have overruled what was learnt before.
    const int lasting = static_cast<int>(scheduler::CostModelSettings().forget_after);
    SavedCosts saved(options_.cost_file);
    if (disturbed_frame_ >= 0 && frames - disturbed_frame_ <= lasting) return saved.keep();
    saved.save(maker_->bodies(), active_devices(), options_.strict_math, planner_->timing());
}

/// What others take of the cores, more than now and then, is more than a run's own noise.
void PlannedExecutor::look_at_load(int frame) {
    constexpr double kDisturbing = 0.15;
    if (load_.others_share().value_or(0.0) > kDisturbing) disturbed_frame_ = frame;
}

/// The first round compiles, loads and pages in.
void PlannedExecutor::calibrate(int instances, bool costs_known, const std::function<void()>& undo,
                                std::vector<std::string>& warnings) {
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds; ++round) {
        for (const FramePlan& plan : planner_->calibration()) {
            const auto before = thread_times();
            const RunTimes times = executor_->run(*plan.step, plan.plan, instances);
            const double threads = threads_at_work(before, thread_times());
            make_room();
            if (round == kRounds - 1) note_limits(plan, times, threads, warnings);
            if (round > 0 || !costs_known) planner_->learn(plan, times, instances);
            undo();
        }
    }
}

/// A driver may work with more threads than the part of its device that was asked for has units
/// (Intel's does).
void PlannedExecutor::note_limits(const FramePlan& plan, const RunTimes& times, double threads,
                                  std::vector<std::string>& warnings) const {
    constexpr double kTooMany = 1.5;    // per unit: somebody submits, too
    constexpr double kShortest = 2e-3;  // [s] below that, submitting is most of it
    if (std::popcount(plan.devices()) != 1 || times.end - times.start < kShortest) return;
    const auto number = static_cast<std::size_t>(std::countr_zero(plan.devices()));
    const DeviceInfo& device = active_devices()[number]->info();
    if (device.kind != "opencl" || threads < kTooMany * device.units) return;
    char count[32];
    std::snprintf(count, sizeof count, "%.1f", threads);
    warnings.push_back(device.name + " was limited to " + std::to_string(device.units) +
                       " compute unit" + (device.units == 1 ? "" : "s") + ", and works with " +
                       count +
                       " threads: its driver does not honour the limit, so it takes the other "
                       "devices' cores, too");
}

/// The first instance wakes devices and brings data along, the second one tells.
std::optional<PlannedExecutor::Beginning> PlannedExecutor::try_out(const FramePlan& plan,
                                                                   int instances) {
    constexpr int kWorthwhile = 4;  // instances: below, most of the frame would be over
    if (!std::isfinite(plan.patience) || instances < kWorthwhile) return Beginning{};
    Beginning beginning;
    beginning.times = executor_->run(*plan.step, plan.plan, 1, 0);
    RunTimes second = executor_->run(*plan.step, plan.plan, 1, 1);
    const double substep = second.end - second.start;
    beginning.times.append(std::move(second));
    beginning.instances = 2;
    if (substep <= plan.patience) return beginning;
    planner_->give_up(plan, beginning.times.end - beginning.times.start, substep);
    return std::nullopt;
}

void PlannedExecutor::learn(const FramePlan& plan, const RunTimes& times, int instances,
                            int frame) {
    planner_->learn(plan, times, instances);
    look_at_load(frame);
}

void PlannedExecutor::record(const FramePlan& plan, const RunTimes& times, int instances,
                             bool tasks, FrameRecord& frame) {
    recorder_.sum_up(plan, times, instances, active_, frame);
    if (tasks) recorder_.list(plan, times, planner_->timing(), active_, frame);
}

bool PlannedExecutor::make_room() { return grow_tables(maker_->tables(), *executor_); }

void PlannedExecutor::forget_entries() {
    std::vector<BufferStorage*> columns;
    for (RowTable* table : maker_->tables()) {
        table->forget();
        std::ranges::copy(table->resized_buffers(), std::back_inserter(columns));
    }
    executor_->rebind(columns);
}

void PlannedExecutor::make_room_ahead() {
    for (RowTable* table : maker_->tables()) {
        executor_->fetch(table->needs());
        if (table->is_tight()) grow(*table, {}, *executor_);
    }
}

/// What a table lacks hides from those behind it what they would have lacked, so these grow, too,
/// lest it shows when the frame is run again.
bool grow_tables(const std::vector<RowTable*>& tables, Executor& executor) {
    const auto larger = [](float a, float b) { return std::max(a, b); };
    bool lacked = false;
    std::vector<float> unseen;  // [strips]
    for (RowTable* table : tables) {
        executor.fetch(table->needs());
        const std::vector<float> own = table->shortages();
        if (unseen.size() != own.size()) unseen.assign(own.size(), 1.0f);
        const bool lacks = table->overflowed();
        if (lacks || (lacked && table->is_tight(unseen))) grow(*table, unseen, executor);
        lacked = lacked || lacks;
        std::ranges::transform(unseen, own, unseen.begin(), larger);
    }
    return lacked;
}

}  // namespace weft
