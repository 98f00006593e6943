#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/planning/planned_executor.h"
#include "runtime/trace/records.h"
#include "scheduler/plan.h"
#include "simulation/run/live_model.h"
#include "simulation/run/simulation_options.h"
#include "simulation/run/troubles.h"

namespace weft {

class FrameJudge;
class FrameRunner;
struct Energies;
struct FrozenContact;

/// What a frame's record holds besides times, makespans and bytes. Each takes time between frames.
struct FrameDetails {
    bool tasks = true;  ///< plan, executions, costs, links, transfers
    bool state_hash = false;
};

/// A scene on devices, frame by frame. The results do not depend on the devices or on the plans,
/// but for asynchronous ones.
class Simulation {
public:
    /// Throws UserError for a scene or devices that cannot be had.
    Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings);
    /// On devices that the caller has opened; options.devices is not used.
    Simulation(const Scene& scene, std::vector<std::unique_ptr<Device>> devices,
               const SimulationOptions& options, Warnings& warnings);
    ~Simulation();

    /// Simulates the next frame: plans, runs all substeps, looks at the state, and measures what
    /// the details ask for. The record's end is that of the call, and its parts add up to it. If a
    /// device fails, the frame is done again from its start on the others, with the same result.
    /// Throws RunError if none is left, or the state went bad and options.on_trouble does not go
    /// on; then the state is that of the frame's start.
    FrameRecord advance(const FrameDetails& details = {});
    /// The state between two frames, for those who look at it while the simulation goes on.
    std::shared_ptr<const SimulationState> snapshot() const { return live_->snapshot(); }
    double time() const { return frame_ * model().scene.dt; }  ///< simulated so far [s]
    /// Seconds since the start, as records count them.
    double clock() const { return live_->planned().executor().clock(); }
    /// The devices that failed so far.
    const std::vector<LostDevice>& losses() const { return live_->planned().losses(); }
    /// What was wrong so far, and is no error by options.on_trouble.
    const std::vector<Trouble>& troubles() const;
    /// The state between two frames, all of it.
    Checkpoint checkpoint() const;
    /// Goes on from there, with the results of a run that was never interrupted. Throws UserError
    /// if the checkpoint's state has another size.
    void resume(const Checkpoint& checkpoint);
    /// Keeps what was learnt about the devices for later runs, in options.cost_file; not what was
    /// learnt while others kept the cores busy.
    void save_costs() { live_->planned().save_costs(frame_); }

    /// Goes on from another state, at the start of `frame`: as positions() and velocities() have
    /// it. What a solver remembers of earlier substeps is forgotten.
    void start_from(int frame, std::span<const float> positions, std::span<const float> velocities);

    /// Simulates the next frame by a plan from elsewhere, a replay's. Nothing is planned, learnt or
    /// measured. Throws RunError if a device failed or the state went bad.
    void advance_by(const Step& step, const scheduler::Plan& plan);
    /// Goes on with so many substeps per frame and iterations of each, from here on. What a solver
    /// remembers of substeps of another length is forgotten.
    void set_steps(int substeps, int iterations);
    Step make_step(const Division& division) {
        return live_->solver().make_step(
            division.partition().spread(live_->solver().iterate_count()));
    }

    int frame() const { return frame_; }  ///< the next one
    const Model& model() const { return live_->model(); }
    /// For those who look at a snapshot while the simulation goes on: the model changes with the
    /// substeps.
    std::shared_ptr<const Model> shared_model() const { return live_->shared_model(); }
    const Solver& solver() const { return live_->solver(); }
    const std::vector<std::unique_ptr<Device>>& devices() const {
        return live_->planned().devices();
    }
    const FramePlanner& planner() const { return live_->planned().planner(); }

    /// Why PlanKind::kAuto took an asynchronous plan or did not; empty: there was no such choice.
    const std::string& async_choice() const { return async_choice_; }

    /// The contacts that the last substep found where it began; corners in scene order. Empty:
    /// none, or no [contact].
    std::vector<FrozenContact> contacts();

    /// For traces: everything that is known before the first frame but the command line.
    RunDescription describe() const;

    /// xyz of all vertices in scene order, counted from the model's origin [m], [m/s]. (In the
    /// scene's own coordinates positions may lose digits: Model::in_scene().)
    std::vector<float> positions() const;
    std::vector<float> velocities() const;
    std::string hash() const;
    /// Of the present state [J]; of the first one where options.on_trouble is kIgnore.
    const Energies& energies() const;

private:
    void choose_plan(Warnings& warnings);
    void place() { live_->place(time()); }
    void begin_frame();
    bool advance_from_start(const FrameDetails& details, FrameRecord& frame);
    bool stands(const Step& step, bool may_be_sample, FrameRecord& frame);
    void begin_again(Steps steps);
    [[noreturn]] void stop(const Step& step);
    void end_part(FrameRecord& frame, double& part) const;

    SimulationOptions options_;
    std::unique_ptr<LiveModel> live_;
    std::unique_ptr<FrameRunner> runner_;
    std::unique_ptr<FrameJudge> judge_;
    std::string async_choice_;
    int frame_ = 0;
};

}  // namespace weft
