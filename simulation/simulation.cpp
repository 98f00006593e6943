#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/cores.h"
#include "runtime/error.h"
#include "runtime/executor.h"
#include "runtime/opencl/opencl_device.h"
#include "simulation/diagnosis.h"
#include "simulation/frame_recorder.h"
#include "simulation/planning/frame_planner.h"
#include "simulation/planning/saved_costs.h"
#include "simulation/run_description.h"
#include "simulation/solver/own_iterates.h"
#include "simulation/start_checks.h"
#include "simulation/watch.h"

namespace weft {

namespace {

/// With as many iterates as the options ask for.
std::unique_ptr<Solver> make_solver_for(Model& model, const SimulationOptions& options) {
    auto solver = options.make_solver(model);
    if (options.iterates == 1) return solver;
    return std::make_unique<OwnIterates>(model, std::move(solver), options.iterates);
}

constexpr int kMostRefinement = 16;  ///< times the substeps that a run began with
constexpr std::size_t kMostTroubles = 10;

/// For what is done between frames: as many as the devices have, of the host's.
int host_threads(const std::vector<std::unique_ptr<Device>>& devices) {
    int units = 0;
    for (const auto& device : devices) units += device->info().units;
    return std::clamp(units, 1, static_cast<int>(std::max<std::size_t>(usable_cores().size(), 1)));
}

void record(const Watch::Look& look, FrameRecord& frame) {
    const EnergyAccount::Entry& entry = look.entry;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    frame.strain_rms = look.strain.rms;
    frame.strain_max = look.strain.most;
    frame.kinetic_energy = entry.energies.kinetic;
    frame.gravity_energy = entry.energies.gravity;
    frame.energies = entry.energies.elements;
    frame.work = entry.is_known ? entry.outside.work : unknown;
    frame.dissipated = entry.is_known ? entry.dissipated() : unknown;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings)
    : Simulation(scene, open_devices(options.devices, options.device_options), options, warnings) {}

Simulation::Simulation(const Scene& scene, std::vector<std::unique_ptr<Device>> devices,
                       const SimulationOptions& options, Warnings& warnings)
    : options_(options),
      devices_(std::move(devices)),
      active_(devices_.size()),
      model_(std::make_shared<Model>(scene, warnings)),
      solver_(make_solver_for(*model_, options)),
      recorder_(std::make_unique<FrameRecorder>(devices_.size())),
      watch_(std::make_unique<Watch>(*model_, options.on_trouble != OnTrouble::kIgnore,
                                     host_threads(devices_))),
      first_substeps_(model_->scene.substeps) {
    std::iota(active_.begin(), active_.end(), 0);
    warn_of_start(*model_, warnings);
    if (model_->scene.contact) check_start_contacts(*model_, options.on_crossing, warnings);
    for (std::string& trouble : opencl_troubles()) warnings.push_back(std::move(trouble));
    place();
    open_executor();
    if (options.calibrate) calibrate(restore_costs(), warnings);
}

Simulation::~Simulation() = default;

std::shared_ptr<const SimulationState> Simulation::snapshot() const {
    if (!snapshot_) snapshot_ = snapshots_.take(*model_, *solver_);
    return snapshot_;
}

void Simulation::restore(const SimulationState& state) {
    state.put(*model_, *solver_);
    snapshot_.reset();
    executor_->host_wrote(*model_->positions);
    executor_->host_wrote(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor_->host_wrote(*buffer);
}

Checkpoint Simulation::checkpoint() const {
    Checkpoint checkpoint = snapshot()->checkpoint(frame_);
    checkpoint.substeps = model_->scene.substeps;
    checkpoint.account = watch_->account().save();
    return checkpoint;
}

void Simulation::resume(const Checkpoint& checkpoint) {
    if (checkpoint.substeps != model_->scene.substeps) set_substeps(checkpoint.substeps);
    SimulationState state = *snapshot();
    state.take(checkpoint);
    frame_ = checkpoint.frame;
    place();
    restore(state);
    watch_->restart(*model_, time(), checkpoint.account);
}

/// Everything that knows the length of a step is made anew; devices and costs stay.
void Simulation::set_substeps(int substeps) {
    Scene scene = model_->scene;
    scene.substeps = substeps;
    SimulationState state = *snapshot();
    for (auto& bytes : state.solver) std::fill(bytes.begin(), bytes.end(), std::byte{});
    Warnings said_already;
    auto model = std::make_shared<Model>(scene, said_already);
    for (std::size_t v = 0; v < state.velocities.size(); ++v) {
        state.velocities[v].w = (*model->velocities)[v].w;  // what damping leaves per substep
    }
    auto solver = make_solver_for(*model, options_);
    const TimingModel learnt = planner_->timing();
    model_.swap(model);
    solver_.swap(solver);
    open_executor();  // while those that the old one refers to are there
    std::vector<int> all(active_.size());
    std::iota(all.begin(), all.end(), 0);
    planner_->timing().inherit(learnt, all);
    planner_->balance_mixture();
    place();
    restore(state);
}

void Simulation::start_from(int frame, std::span<const float> positions,
                            std::span<const float> velocities) {
    SimulationState state = *snapshot();
    model_->from_scene_order(positions, state.positions);
    model_->from_scene_order(velocities, state.velocities);
    for (auto& bytes : state.solver) std::fill(bytes.begin(), bytes.end(), std::byte{});
    restore(state);
    frame_ = frame;
    watch_->restart(*model_, time());
}

void Simulation::place() {
    model_->place(time());
    if (executor_) hand_over_placed();
}

void Simulation::hand_over_placed() {
    for (BufferStorage* buffer : model_->placed_buffers()) executor_->host_wrote(*buffer);
}

void Simulation::fetch() {
    executor_->fetch(*model_->positions);
    executor_->fetch(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) executor_->fetch(*buffer);
}

std::vector<Device*> Simulation::active_devices() const {
    std::vector<Device*> list;
    for (const int number : active_)
        list.push_back(devices_[static_cast<std::size_t>(number)].get());
    return list;
}

/// An executor and a planner for the devices that are there.
void Simulation::open_executor() {
    const auto bodies = solver_->bodies();
    const double epoch = executor_ ? executor_->epoch() : now();
    executor_.reset();
    executor_ = std::make_unique<Executor>(active_devices(), bodies, epoch);
    const bool all = active_.size() == devices_.size();
    planner_ =
        std::make_unique<FramePlanner>(*solver_, model_->strips.count(), active_devices(),
                                       options_.plan, all ? options_.division : std::nullopt);
}

bool Simulation::restore_costs() {
    if (options_.cost_file.empty()) return false;
    const SavedCosts saved(options_.cost_file);
    if (!saved.restore(solver_->bodies(), active_devices(), options_.device_options.strict_math,
                       planner_->timing())) {
        return false;
    }
    planner_->balance_mixture();
    return true;
}

void Simulation::save_costs() {
    constexpr int kEnoughFrames = 5;  // the first ones are no rule
    if (options_.cost_file.empty() || frame_ < kEnoughFrames) return;
    look_at_load();
    // Later frames have overruled what was learnt before.
    const int lasting = static_cast<int>(scheduler::CostModelSettings().forget_after);
    SavedCosts saved(options_.cost_file);
    if (disturbed_frame_ >= 0 && frame_ - disturbed_frame_ <= lasting) return saved.keep();
    saved.save(solver_->bodies(), active_devices(), options_.device_options.strict_math,
               planner_->timing());
}

/// What others take of the cores, more than now and then, is more than a run's own noise.
void Simulation::look_at_load() {
    constexpr double kDisturbing = 0.15;
    if (load_.others_share().value_or(0.0) > kDisturbing) disturbed_frame_ = frame_;
}

/// Profiles every device on the scene's own tasks; a substep or two each, undone afterwards. The
/// first round compiles, loads and pages in. Costs that are known from earlier runs are a first
/// guess: the machine may have been busy then.
void Simulation::calibrate(bool costs_known, Warnings& warnings) {
    const auto start = snapshot();
    const int instances = std::min(model_->scene.substeps, 2);
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds; ++round) {
        for (const FramePlan& plan : planner_->calibration()) {
            const auto before = thread_times();
            const RunTimes times = executor_->run(*plan.step, plan.plan, instances);
            const double threads = threads_at_work(before, thread_times());
            make_room();
            if (round == kRounds - 1) note_limits(plan, times, threads, warnings);
            if (round > 0 || !costs_known) planner_->learn(plan, times, instances);
            restore(*start);
        }
    }
}

/// A driver may work with more threads than the part of its device that was asked for has units
/// (Intel's does).
void Simulation::note_limits(const FramePlan& plan, const RunTimes& times, double threads,
                             Warnings& warnings) const {
    constexpr double kTooMany = 1.5;    // per unit: somebody submits, too
    constexpr double kShortest = 2e-3;  // [s] below that, submitting is most of it
    if (std::popcount(plan.devices()) != 1 || times.end - times.start < kShortest) return;
    const auto number = static_cast<std::size_t>(std::countr_zero(plan.devices()));
    const DeviceInfo& device = active_devices()[number]->info();
    if (device.kind != "opencl" || threads < kTooMany * device.units) return;
    warnings.push_back(fmt::format(
        "{} was limited to {} compute unit{}, and works with {:.1f} threads: its driver does not "
        "honour the limit, so it takes the other devices' cores, too",
        device.name, device.units, device.units == 1 ? "" : "s", threads));
}

double Simulation::clock() const { return executor_->clock(); }

FrameRecord Simulation::advance(const FrameDetails& details) {
    FrameRecord frame;
    frame.frame = static_cast<std::uint32_t>(frame_);
    frame.sim_time = time() + model_->scene.dt;
    frame.start = frame.end = clock();
    begin_frame();
    while (true) {
        try {
            if (advance_from_start(details, frame)) return frame;
            end_part(frame, frame.execute_time);
        } catch (const DeviceLost& lost) {
            go_on_without(lost);
            end_part(frame, frame.execute_time);
        }
    }
}

void Simulation::begin_frame() {
    start_ = snapshot();
    snapshot_.reset();
}

/// What has passed since the last part ended belongs to this one.
void Simulation::end_part(FrameRecord& frame, double& part) const {
    const double time = clock();
    part += time - frame.end;
    frame.end = time;
}

/// The state in the middle of a frame is lost with the device, so the frame begins again.
void Simulation::go_on_without(const DeviceLost& lost) {
    const auto place = active_.begin() + static_cast<int>(lost.device);
    const int number = *place;
    const std::string name = devices_[static_cast<std::size_t>(number)]->info().name;
    losses_.push_back({number, frame_, lost.what()});
    active_.erase(place);
    start_->put(*model_, *solver_);
    if (active_.empty()) {
        throw RunError(fmt::format("device {} was lost in frame {}, and there is no other: {}",
                                   name, frame_, lost.what()));
    }
    std::vector<int> kept(active_.size());
    std::iota(kept.begin(), kept.end(), 0);
    for (int& k : kept) k += k >= static_cast<int>(lost.device) ? 1 : 0;
    const TimingModel learnt = planner_->timing();
    open_executor();
    planner_->timing().inherit(learnt, kept);
    planner_->balance_mixture();
}

/// All substeps of the frame. It runs again from its start as long as a table was too small for it;
/// and once more if what is faster than was reckoned with might have gone through an obstacle, with
/// that obstacle swept.
RunTimes Simulation::run_frame(const Step& step, const scheduler::Plan& plan) {
    bool is_swept_anew = false;
    while (true) {
        RunTimes times = executor_->run(step, plan, model_->scene.substeps);
        fetch();
        const bool was_cut_short = make_room();
        if (!was_cut_short && (is_swept_anew || !model_->outran_obstacles())) return times;
        is_swept_anew = is_swept_anew || !was_cut_short;
        restore(*start_);
        hand_over_placed();
    }
}

/// Lets tables grow in which rows had no room. Says whether there were any: then what has been
/// computed is of no use.
bool Simulation::make_room() {
    bool grew = false;
    for (RowTable* table : solver_->tables()) {
        executor_->fetch(table->needs());
        if (!table->overflowed()) continue;
        table->grow();
        executor_->rebind(table->resized_buffers());
        for (BufferStorage* buffer : table->written_buffers()) executor_->host_wrote(*buffer);
        grew = true;
    }
    return grew;
}

/// False: it has to be done again.
bool Simulation::advance_from_start(const FrameDetails& details, FrameRecord& frame) {
    place();
    end_part(frame, frame.place_time);
    const FramePlan& plan = planner_->next();
    end_part(frame, frame.plan_time);
    const int substeps = model_->scene.substeps;
    const RunTimes times = run_frame(*plan.step, plan.plan);
    end_part(frame, frame.execute_time);
    const bool accepted = accepts(*plan.step, frame);
    end_part(frame, frame.check_time);
    if (!accepted) return false;
    recorder_->sum_up(plan, times, substeps, active_, frame);
    if (details.tasks) {
        recorder_->list(plan, times, planner_->timing().costs(), active_, frame);
    }
    planner_->learn(plan, times, substeps);
    look_at_load();
    end_part(frame, frame.learn_time);
    ++frame_;
    if (details.state_hash) frame.state_hash = hash();
    end_part(frame, frame.measure_time);
    return true;
}

void Simulation::advance_by(const Step& step, const scheduler::Plan& plan) {
    begin_frame();
    place();
    run_frame(step, plan);
    FrameRecord frame;
    accepts(step, frame);
    ++frame_;
}

/// Looks at the frame that has just run, and writes down what there is to see.
bool Simulation::accepts(const Step& step, FrameRecord& frame) {
    const double end = time() + model_->scene.dt;
    const Watch::Look look = watch_->look(*model_, *start_, time(), end);
    if (look.alarm && !goes_on_with(*look.alarm, step)) return false;
    watch_->accept(look, look.alarm.has_value());
    record(look, frame);
    frame.substeps = static_cast<std::uint32_t>(model_->scene.substeps);
    return true;
}

bool Simulation::goes_on_with(const Alarm& alarm, const Step& step) {
    if (options_.on_trouble == OnTrouble::kHalve && halve(alarm)) return false;
    const bool is_told =
        alarm.kind == Alarm::Kind::kDoubt ||
        (alarm.kind == Alarm::Kind::kExplosion && options_.on_trouble == OnTrouble::kReport);
    if (!is_told) {
        restore(*start_);
        diagnose_frame(frame_, *start_, *watch_, step, *model_, *solver_);
    }
    tell(alarm,
         "the steps are not solved far enough, and what is seen is not believable: more substeps "
         "or iterations, or another solver, may help (docs/stability.md)");
    return true;
}

/// Whether the frame is to be done again with steps of half the size.
bool Simulation::halve(const Alarm& alarm) {
    const int substeps = 2 * model_->scene.substeps;
    if (substeps > kMostRefinement * first_substeps_) return false;
    restore(*start_);
    set_substeps(substeps);
    start_ = snapshot();
    snapshot_.reset();
    tell(alarm, fmt::format("done again, and all that follows, with {} substeps", substeps));
    return true;
}

void Simulation::tell(const Alarm& alarm, const std::string& what) {
    if (troubles_.size() >= kMostTroubles) return;
    std::string text = fmt::format("{}; {}", alarm.what, what);
    if (troubles_.size() + 1 == kMostTroubles) text += "; what comes after this is not told";
    troubles_.push_back({frame_, text, alarm.kind != Alarm::Kind::kDoubt});
}

RunDescription Simulation::describe() const { return describe_run(*model_, *solver_, devices_); }

std::vector<float> Simulation::positions() const { return snapshot()->scene_positions(*model_); }
std::vector<float> Simulation::velocities() const { return snapshot()->scene_velocities(*model_); }
std::string Simulation::hash() const { return snapshot()->hash(*model_); }

}  // namespace weft
