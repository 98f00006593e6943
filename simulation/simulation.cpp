#include "simulation/simulation.h"

#include <algorithm>
#include <utility>

#include "runtime/cores.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/parallel.h"
#include "runtime/unused_memory.h"
#include "simulation/checks/diagnosis.h"
#include "simulation/checks/start_checks.h"
#include "simulation/choice/async_choice.h"
#include "simulation/choice/solver_choice.h"
#include "simulation/contact/frozen.h"
#include "simulation/description/run_description.h"
#include "simulation/run/frame_judge.h"
#include "simulation/run/frame_runner.h"
#include "simulation/run/solver_maker.h"
#include "simulation/scene/auto_method.h"

namespace weft {

namespace {

/// Where nobody has chosen a solver yet, it is chosen now.
Scene settled(const Scene& scene, PlanKind plan) {
    return auto_method(scene) ? with_choice(scene, choose_solver(scene, plan)) : scene;
}

/// For setting up, and for what is done between frames: as many as the devices have, of the host's.
int host_threads(const std::vector<std::unique_ptr<Device>>& devices) {
    int units = 0;
    for (const auto& device : devices) units += device->info().units;
    return std::clamp(units, 1, static_cast<int>(std::max<std::size_t>(usable_cores().size(), 1)));
}

template <class Make>
auto made_with(int threads, const Make& make) {
    decltype(make()) made;
    HostThreads(threads).execute([&] { made = make(); });
    return made;
}

}  // namespace

Simulation::Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings)
    : Simulation(scene, open_devices(options.devices, options.device_options), options, warnings) {}

Simulation::Simulation(const Scene& scene, std::vector<std::unique_ptr<Device>> devices,
                       const SimulationOptions& options, Warnings& warnings)
    : options_(options),
      live_(made_with(host_threads(devices),
                      [&, chosen = settled(scene, options.plan)] {
                          return std::make_unique<LiveModel>(
                              chosen, solver_maker(options, devices.size()), warnings);
                      })),
      runner_(std::make_unique<FrameRunner>(*live_)),
      judge_(std::make_unique<FrameJudge>(*live_, options.on_trouble, options.on_crossing,
                                          host_threads(devices))) {
    warn_of_start(model(), warnings);
    if (model().scene.contact) check_start_contacts(model(), options.on_crossing, warnings);
    for (std::string& trouble : opencl_troubles()) warnings.push_back(std::move(trouble));
    place();
    give_back_freed();
    live_->open(std::move(devices), {options.plan, options.division, options.cost_file,
                                     options.device_options.strict_math});
    if (!options.calibrate) return;
    live_->calibrate(warnings);
    choose_plan(warnings);
}

Simulation::~Simulation() = default;

/// Once, before the first frame: the results of a run are those of one kind of plan.
void Simulation::choose_plan(Warnings& warnings) {
    const AsyncChoice choice = choose_async(options_, *live_);
    async_choice_ = choice.why;
    if (!choice.settings) return;
    options_.plan = PlanKind::kAsync;
    options_.async = *choice.settings;
    live_->set_solver(solver_maker(options_, devices().size()), PlanKind::kAsync, time());
    live_->calibrate(warnings);
}

FrameRecord Simulation::advance(const FrameDetails& details) {
    FrameRecord frame;
    frame.frame = static_cast<std::uint32_t>(frame_);
    frame.sim_time = time() + model().scene.dt;
    frame.start = frame.end = clock();
    begin_frame();
    bool has_lost_state = false;
    while (true) {
        try {
            if (has_lost_state) live_->go_back_to_start();
            has_lost_state = false;
            if (advance_from_start(details, frame)) return frame;
            end_part(frame, frame.execute_time);
        } catch (const DeviceLost& lost) {
            live_->go_on_without(lost, frame_);
            has_lost_state = true;
            end_part(frame, frame.execute_time);
        }
    }
}

void Simulation::begin_frame() {
    live_->begin_frame();
    runner_->begin_frame();
}

/// False: it has to be done again.
bool Simulation::advance_from_start(const FrameDetails& details, FrameRecord& frame) {
    PlannedExecutor& planned = live_->planned();
    planned.make_room_ahead();
    place();
    end_part(frame, frame.place_time);
    const FramePlan& plan = planned.next();
    end_part(frame, frame.plan_time);
    const int substeps = model().scene.substeps;
    const auto times = runner_->run(plan, frame_, judge_->samples());
    end_part(frame, frame.execute_time);
    if (!times) return false;
    const bool is_kept = stands(*plan.step, true, frame);
    end_part(frame, frame.check_time);
    if (!is_kept) return false;
    planned.record(plan, *times, substeps, details.tasks, frame);
    planned.learn(plan, *times, substeps, frame_);
    end_part(frame, frame.learn_time);
    ++frame_;
    live_->end_frame();
    if (const auto steps = judge_->steps_behind(frame)) {
        set_steps(steps->substeps, steps->iterations);
    }
    if (details.state_hash) frame.state_hash = hash();
    end_part(frame, frame.measure_time);
    return true;
}

void Simulation::advance_by(const Step& step, const scheduler::Plan& plan) {
    begin_frame();
    live_->planned().make_room_ahead();
    place();
    runner_->run(step, plan, frame_, judge_->samples());
    FrameRecord frame;
    stands(step, false, frame);
    ++frame_;
}

/// What has passed since the last part ended belongs to this one.
void Simulation::end_part(FrameRecord& frame, double& part) const {
    const double time = clock();
    part += time - frame.end;
    frame.end = time;
}

/// Whether the frame that has just run is kept; else the model is at its start again, with other
/// steps.
bool Simulation::stands(const Step& step, bool may_be_sample, FrameRecord& frame) {
    const Verdict verdict = judge_->judge({frame_, runner_->redone(), may_be_sample}, frame);
    if (verdict.kind == Verdict::Kind::kStop) stop(step);
    if (verdict.kind == Verdict::Kind::kAgain) begin_again(verdict.steps);
    return verdict.kind == Verdict::Kind::kKeep;
}

void Simulation::begin_again(Steps steps) {
    live_->restore(live_->start());
    set_steps(steps.substeps, steps.iterations);
    live_->begin_frame();
}

/// With the error that says what went wrong, and where.
void Simulation::stop(const Step& step) {
    live_->restore(live_->start());
    diagnose_frame(frame_, live_->start(), judge_->watch(), step, live_->model(), live_->solver(),
                   judge_->advice());
}

void Simulation::set_steps(int substeps, int iterations) {
    const bool has_other_length = substeps != model().scene.substeps;
    live_->set_steps({substeps, iterations}, time());
    if (has_other_length) judge_->expect_other_length();
}

Checkpoint Simulation::checkpoint() const {
    Checkpoint checkpoint = snapshot()->checkpoint(frame_);
    checkpoint.substeps = model().scene.substeps;
    checkpoint.iterations = model().scene.solver.iterations;
    judge_->save(checkpoint);
    return checkpoint;
}

void Simulation::resume(const Checkpoint& checkpoint) {
    set_steps(checkpoint.substeps, checkpoint.iterations);
    SimulationState state = *snapshot();
    state.take(checkpoint);
    frame_ = checkpoint.frame;
    place();
    live_->restore(state);
    judge_->resume(time(), checkpoint);
}

void Simulation::start_from(int frame, std::span<const float> positions,
                            std::span<const float> velocities) {
    live_->start_from(positions, velocities);
    frame_ = frame;
    judge_->restart(time());
}

RunDescription Simulation::describe() const {
    RunDescription run = describe_run(model(), live_->solver(), devices());
    if (!async_choice_.empty()) run.settings.emplace_back("async_choice", async_choice_);
    return run;
}

const std::vector<Trouble>& Simulation::troubles() const { return judge_->troubles().list(); }
std::vector<FrozenContact> Simulation::contacts() { return live_->contacts(); }
std::vector<float> Simulation::positions() const { return snapshot()->ordered_positions(model()); }
std::vector<float> Simulation::velocities() const {
    return snapshot()->ordered_velocities(model());
}
std::string Simulation::hash() const { return snapshot()->hash(model()); }
const Energies& Simulation::energies() const { return judge_->watch().account().last().energies; }

}  // namespace weft
