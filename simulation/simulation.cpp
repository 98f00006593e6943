#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/cores.h"
#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/unused_memory.h"
#include "simulation/async_offer.h"
#include "simulation/checks/crossing_checks.h"
#include "simulation/checks/error_samples.h"
#include "simulation/checks/start_checks.h"
#include "simulation/checks/watch.h"
#include "simulation/contact/response.h"
#include "simulation/run_description.h"
#include "simulation/scene/auto_method.h"
#include "simulation/solver/async_iterates.h"
#include "simulation/solver/own_iterates.h"
#include "simulation/solver_choice.h"

namespace weft {

namespace {

/// Where nobody has chosen a solver yet, it is chosen now.
Scene settled(const Scene& scene, PlanKind plan) {
    return auto_method(scene) ? with_choice(scene, choose_solver(scene, plan)) : scene;
}

/// With as many iterates as the options ask for, or asynchronous devices need.
std::unique_ptr<Solver> make_solver_for(Model& model, const SimulationOptions& options,
                                        std::size_t devices) {
    const bool by_kinds =
        options.plan == PlanKind::kAsync && options.async.tasks == AsyncSettings::Tasks::kKinds;
    auto solver = by_kinds ? make_solver_by_kinds(model) : options.make_solver(model);
    if (options.plan == PlanKind::kAsync) {
        const int iterates = std::max(options.iterates, static_cast<int>(devices));
        return std::make_unique<AsyncIterates>(model, std::move(solver), iterates, options.async);
    }
    if (options.iterates == 1) return solver;
    return std::make_unique<OwnIterates>(model, std::move(solver), options.iterates);
}

/// For what is done between frames: as many as the devices have, of the host's.
int host_threads(const std::vector<std::unique_ptr<Device>>& devices) {
    int units = 0;
    for (const auto& device : devices) units += device->info().units;
    return std::clamp(units, 1, static_cast<int>(std::max<std::size_t>(usable_cores().size(), 1)));
}

}  // namespace

Simulation::Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings)
    : Simulation(scene, open_devices(options.devices, options.device_options), options, warnings) {}

Simulation::Simulation(const Scene& scene, std::vector<std::unique_ptr<Device>> devices,
                       const SimulationOptions& options, Warnings& warnings)
    : options_(options),
      model_(std::make_shared<Model>(settled(scene, options.plan), warnings)),
      solver_(make_solver_for(*model_, options, devices.size())),
      watch_(std::make_unique<Watch>(*model_, options.on_trouble != OnTrouble::kIgnore,
                                     host_threads(devices))),
      first_substeps_(model_->scene.substeps),
      most_iterations_(model_->scene.solver.iterations) {
    if (options.on_trouble != OnTrouble::kIgnore) {
        samples_ = std::make_unique<ErrorSamples>(*model_, host_threads(devices));
    }
    warn_of_start(*model_, warnings);
    if (model_->scene.contact) {
        check_start_contacts(*model_, options.on_crossing, warnings);
        if (options.on_trouble != OnTrouble::kIgnore) {
            crossings_ =
                std::make_unique<CrossingChecks>(*model_, options.on_crossing == OnCrossing::kWarn);
        }
    }
    for (std::string& trouble : opencl_troubles()) warnings.push_back(std::move(trouble));
    place();
    give_back_freed();
    run_ = std::make_unique<PlannedExecutor>(
        *solver_, model_->strips.count(), std::move(devices),
        PlanningOptions{options.plan, options.division, options.cost_file,
                        options.device_options.strict_math});
    if (!options.calibrate) return;
    calibrate(warnings);
    if (has_async_choice())
        choose_async(warnings);
    else if (options_.may_be_async && options_.plan == PlanKind::kAuto)
        async_choice_ = "not async: " + why_no_async_choice();
}

Simulation::~Simulation() = default;

std::shared_ptr<const SimulationState> Simulation::snapshot() const {
    if (!snapshot_) snapshot_ = snapshots_.take(*model_, *solver_);
    return snapshot_;
}

void Simulation::restore(const SimulationState& state) {
    state.put(*model_, *solver_);
    snapshot_.reset();
    run_->executor().host_wrote(*model_->positions);
    run_->executor().host_wrote(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) run_->executor().host_wrote(*buffer);
    if (ContactResponse* contact = solver_->contact()) {
        run_->executor().host_wrote(contact->forget());
    }
}

Checkpoint Simulation::checkpoint() const {
    Checkpoint checkpoint = snapshot()->checkpoint(frame_);
    checkpoint.substeps = model_->scene.substeps;
    checkpoint.iterations = model_->scene.solver.iterations;
    checkpoint.failed_iterations = failed_iterations_;
    checkpoint.account = watch_->account().save();
    return checkpoint;
}

void Simulation::resume(const Checkpoint& checkpoint) {
    set_steps(checkpoint.substeps, checkpoint.iterations);
    failed_iterations_ = checkpoint.failed_iterations;
    SimulationState state = *snapshot();
    state.take(checkpoint);
    frame_ = checkpoint.frame;
    place();
    restore(state);
    watch_->restart(*model_, time(), checkpoint.account);
    if (samples_) samples_->resume(*model_);
}

/// Everything that knows the length of a step is made anew; devices and costs stay.
void Simulation::set_steps(int substeps, int iterations) {
    Scene scene = model_->scene;
    const bool has_other_length = substeps != scene.substeps;
    if (!has_other_length && iterations == scene.solver.iterations) return;
    scene.substeps = substeps;
    scene.solver.iterations = iterations;
    SimulationState state = *snapshot();
    if (has_other_length) {
        for (auto& bytes : state.solver) std::fill(bytes.begin(), bytes.end(), std::byte{});
    }
    Warnings said_already;
    auto model = std::make_shared<Model>(scene, said_already);
    for (std::size_t v = 0; v < state.velocities.size(); ++v) {
        state.velocities[v].w = (*model->velocities)[v].w;  // what damping leaves per substep
    }
    auto solver = make_solver_for(*model, options_, run_->devices().size());
    model_.swap(model);
    solver_.swap(solver);
    run_->take_over(*solver_, model_->strips.count());  // while those before are there
    if (samples_ && has_other_length) samples_->reset();
    if (has_other_length) watch_->expect_other_contacts();
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
    if (samples_) samples_->restart(*model_, time());
}

void Simulation::place() {
    model_->place(time());
    if (ContactResponse* contact = solver_->contact()) contact->motion().place(time());
    if (run_) hand_over_placed();
}

void Simulation::hand_over_placed() {
    std::vector<BufferStorage*> buffers = model_->placed_buffers();
    if (ContactResponse* contact = solver_->contact()) {
        for (BufferStorage* buffer : contact->motion().placed_buffers()) buffers.push_back(buffer);
    }
    for (BufferStorage* buffer : buffers) run_->executor().host_wrote(*buffer);
}

void Simulation::fetch() {
    run_->executor().fetch(*model_->positions);
    run_->executor().fetch(*model_->velocities);
    for (BufferStorage* buffer : solver_->state()) run_->executor().fetch(*buffer);
}

/// A substep or two on every device, undone afterwards.
void Simulation::calibrate(Warnings& warnings) {
    const bool costs_known = run_->restore_costs();
    const auto start = snapshot();
    const int instances = std::min(model_->scene.substeps, 2);
    run_->calibrate(
        instances, costs_known, [&] { restore(*start); }, warnings);
}

/// Where several devices could share the scene, and nobody has said how. Whoever measures single
/// steps chooses by himself.
bool Simulation::has_async_choice() const {
    const bool is_open = options_.plan == PlanKind::kAuto && !options_.division &&
                         options_.iterates == 1 && options_.on_trouble != OnTrouble::kIgnore;
    return is_open && run_->division_by_units().devices().size() > 1 &&
           !solver_->asynchrony().kinds.empty();
}

std::string Simulation::why_no_async_choice() const {
    if (solver_->asynchrony().kinds.empty()) {
        return fmt::format("{} has no asynchronous form", name_of(model_->scene.solver.method));
    }
    if (run_->division_by_units().devices().size() < 2) return "one device has nobody to wait for";
    return "it is said who does what";
}

/// Once, before the first frame: the results of a run are those of one kind of plan.
void Simulation::choose_async(Warnings& warnings) {
    AsyncSettings settings = options_.async;
    settings.tasks = AsyncSettings::Tasks::kStrips;
    const AsyncOffer offer({*model_, *solver_, run_->next(), run_->planner().timing(),
                            run_->division_by_units(), settings});
    async_choice_ = offer.why();
    if (!offer.is_better()) return;
    if (!options_.may_be_async) {
        async_choice_ = "not " + async_choice_ +
                        "; but its results depend on the cuts between devices, so it has to be "
                        "allowed (--async) or asked for (--plan async)";
        return;
    }
    options_.plan = PlanKind::kAsync;
    options_.async = settings;
    const auto start = snapshot();
    auto solver = make_solver_for(*model_, options_, run_->devices().size());
    solver_.swap(solver);
    run_->take_over(*solver_, model_->strips.count(), PlanKind::kAsync);
    place();
    restore(*start);
    calibrate(warnings);
}

FrameRecord Simulation::advance(const FrameDetails& details) {
    FrameRecord frame;
    frame.frame = static_cast<std::uint32_t>(frame_);
    frame.sim_time = time() + model_->scene.dt;
    frame.start = frame.end = clock();
    begin_frame();
    bool has_lost_state = false;
    while (true) {
        try {
            if (has_lost_state) go_back_to_start();
            has_lost_state = false;
            if (advance_from_start(details, frame)) return frame;
            end_part(frame, frame.execute_time);
        } catch (const DeviceLost& lost) {
            go_on_without(lost);
            has_lost_state = true;
            end_part(frame, frame.execute_time);
        }
    }
}

void Simulation::begin_frame() {
    start_ = snapshot();
    snapshot_.reset();
    was_redone_ = redone_ > 0;
    redone_ = 0;
}

/// What has passed since the last part ended belongs to this one.
void Simulation::end_part(FrameRecord& frame, double& part) const {
    const double time = clock();
    part += time - frame.end;
    frame.end = time;
}

/// The state in the middle of a frame is lost with the device, so the frame begins again.
void Simulation::go_on_without(const DeviceLost& lost) {
    start_->put(*model_, *solver_);
    run_->go_on_without(lost, frame_);
}

/// Also of what is no part of the state: contact's candidates are those of some substep or other.
void Simulation::go_back_to_start() {
    restore(*start_);
    hand_over_placed();
}

/// All substeps of the frame. It runs again from its start as long as a table was too small for it;
/// once more if bodies went where contact did not look for them; and once more if what is faster
/// than was reckoned with might have gone through an obstacle, with that obstacle swept.
RunTimes Simulation::run_frame(const Step& step, const scheduler::Plan& plan) {
    bool is_swept_anew = false;
    while (true) {
        auto times = try_substeps(step, plan);
        if (times && (is_swept_anew || !model_->outran_obstacles())) return std::move(*times);
        is_swept_anew = is_swept_anew || times.has_value();
        if (!times) ++redone_;
        go_back_to_start();
    }
}

/// None: they have to be done again. What frames lack that were done again shows in their first
/// substep as a rule, so it is looked at before the others are begun. (Looking more often does not
/// pay: how much room is needed is known when all substeps have run.)
std::optional<RunTimes> Simulation::try_substeps(const Step& step, const scheduler::Plan& plan) {
    const bool is_doubtful = (redone_ > 0 || was_redone_) && model_->scene.substeps > 1;
    RunTimes times;
    if (is_doubtful) {
        times = run_->executor().run(step, plan, 1);
        if (lacks_room()) return std::nullopt;
    }
    times.append(run_substeps(step, plan, is_doubtful ? 1 : 0));
    fetch();
    if (lacks_room()) return std::nullopt;
    return times;
}

/// Whether substeps that have run cannot stay as they are; they will find room when they run again.
bool Simulation::lacks_room() {
    ContactResponse* contact = solver_->contact();
    return run_->make_room() || (contact != nullptr && contact->revise(run_->executor()));
}

/// From substep `first` on. Where the last one is wanted, its start is looked at.
RunTimes Simulation::run_substeps(const Step& step, const scheduler::Plan& plan, int first) {
    const int last = model_->scene.substeps - 1;
    Executor& executor = run_->executor();
    if (!samples_ || !samples_->wants(*model_, frame_)) {
        if (samples_) samples_->skip();
        return executor.run(step, plan, last + 1 - first, first);
    }
    RunTimes times;
    if (last > first) times = executor.run(step, plan, last - first, first);
    if (last > 0) {
        executor.fetch(*model_->positions);
        executor.fetch(*model_->velocities);
    }
    samples_->begin(*model_, time() + last * model_->h);
    times.append(executor.run(step, plan, 1, last));
    return times;
}

/// False: it has to be done again.
bool Simulation::advance_from_start(const FrameDetails& details, FrameRecord& frame) {
    run_->make_room_ahead();
    place();
    end_part(frame, frame.place_time);
    const FramePlan& plan = run_->next();
    end_part(frame, frame.plan_time);
    const int substeps = model_->scene.substeps;
    const RunTimes times = run_frame(*plan.step, plan.plan);
    end_part(frame, frame.execute_time);
    const bool accepted = accepts(*plan.step, true, frame);
    end_part(frame, frame.check_time);
    if (!accepted) return false;
    run_->record(plan, times, substeps, details.tasks, frame);
    run_->learn(plan, times, substeps, frame_);
    end_part(frame, frame.learn_time);
    ++frame_;
    start_.reset();  // nobody goes back there any more
    iterate_less(frame.relative_error);
    if (details.state_hash) frame.state_hash = hash();
    end_part(frame, frame.measure_time);
    return true;
}

void Simulation::advance_by(const Step& step, const scheduler::Plan& plan) {
    begin_frame();
    run_->make_room_ahead();
    place();
    run_frame(step, plan);
    FrameRecord frame;
    accepts(step, false, frame);
    ++frame_;
}

RunDescription Simulation::describe() const {
    RunDescription run = describe_run(*model_, *solver_, devices());
    if (!async_choice_.empty()) run.settings.emplace_back("async_choice", async_choice_);
    return run;
}

std::vector<float> Simulation::positions() const { return snapshot()->ordered_positions(*model_); }
std::vector<float> Simulation::velocities() const {
    return snapshot()->ordered_velocities(*model_);
}
std::string Simulation::hash() const { return snapshot()->hash(*model_); }
const Energies& Simulation::energies() const { return watch_->account().last().energies; }

}  // namespace weft
