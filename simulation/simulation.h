#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/device_list.h"
#include "runtime/planning/planned_executor.h"
#include "runtime/trace/records.h"
#include "scheduler/plan.h"
#include "simulation/checks/start_contacts.h"
#include "simulation/snapshots.h"
#include "simulation/solver/async_settings.h"
#include "simulation/solver/solver.h"

namespace weft {

class CrossingChecks;
class ErrorSamples;
struct StepEstimate;
class Watch;
struct Alarm;
struct Energies;
struct FrozenContact;
struct StoredInContacts;

/// What is done about a frame that ends in a state that cannot be.
enum class OnTrouble {
    kStop,    ///< the run ends with an error; what is only doubtful is told
    kHalve,   ///< the frame is done again with steps of half the size, and so all that follow
    kReport,  ///< it is told, and the run goes on while there is a state to go on from
    kIgnore,  ///< energies are not looked at: for those who measure single steps
};

struct SimulationOptions {
    std::string devices = "hybrid";
    PlanKind plan = PlanKind::kAuto;
    DeviceOptions device_options;
    std::optional<Division> division;  ///< fixed instead of planned
    std::filesystem::path cost_file;   ///< where costs are kept between runs; empty: nowhere
    bool calibrate = true;             ///< measure the devices at the start; needed to plan
    int iterates = 1;                  ///< that devices may have of their own (Partition::spread)
    AsyncSettings async;               ///< for PlanKind::kAsync
    /// Whether PlanKind::kAuto may take an asynchronous plan if that is predicted to be faster: the
    /// results are then others, and which, depends on measured times.
    bool may_be_async = false;
    /// Instead of the solver that the scene names, for tests and studies.
    std::function<std::unique_ptr<Solver>(Model&)> make_solver = weft::make_solver;
    OnTrouble on_trouble = OnTrouble::kStop;
    OnCrossing on_crossing = OnCrossing::kStop;
};

/// What a frame's record holds besides times, makespans and bytes. Each takes time between frames.
struct FrameDetails {
    bool tasks = true;  ///< plan, executions, costs, links, transfers
    bool state_hash = false;
};

/// A frame whose result is to be doubted, or that was done again with smaller steps.
struct Trouble {
    int frame = 0;
    std::string what;
    bool is_explosion = false;  ///< else it is only to be doubted
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
    std::shared_ptr<const SimulationState> snapshot() const;
    double time() const { return frame_ * model_->scene.dt; }  ///< simulated so far [s]
    /// Seconds since the start, as records count them.
    double clock() const { return run_->executor().clock(); }
    /// The devices that failed so far.
    const std::vector<LostDevice>& losses() const { return run_->losses(); }
    /// What was wrong so far, and is no error by options.on_trouble.
    const std::vector<Trouble>& troubles() const { return troubles_; }
    /// The state between two frames, all of it.
    Checkpoint checkpoint() const;
    /// Goes on from there, with the results of a run that was never interrupted. Throws UserError
    /// if the checkpoint's state has another size.
    void resume(const Checkpoint& checkpoint);
    /// Keeps what was learnt about the devices for later runs, in options.cost_file; not what was
    /// learnt while others kept the cores busy.
    void save_costs() { run_->save_costs(frame_); }

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
        return solver_->make_step(division.partition().spread(solver_->iterate_count()));
    }

    int frame() const { return frame_; }  ///< the next one
    const Model& model() const { return *model_; }
    /// For those who look at a snapshot while the simulation goes on: the model changes with the
    /// substeps.
    std::shared_ptr<const Model> shared_model() const { return model_; }
    const Solver& solver() const { return *solver_; }
    const std::vector<std::unique_ptr<Device>>& devices() const { return run_->devices(); }
    const FramePlanner& planner() const { return run_->planner(); }

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
    void restore(const SimulationState& state);

    void place();
    void hand_over_placed();
    void calibrate(Warnings& warnings);
    bool has_async_choice() const;
    std::string why_no_async_choice() const;
    void choose_async(Warnings& warnings);
    void fetch();
    bool advance_from_start(const FrameDetails& details, FrameRecord& frame);
    RunTimes run_frame(const Step& step, const scheduler::Plan& plan);
    std::optional<RunTimes> try_substeps(const Step& step, const scheduler::Plan& plan);
    bool lacks_room();
    RunTimes run_substeps(const Step& step, const scheduler::Plan& plan, int first);
    void begin_frame();
    void end_part(FrameRecord& frame, double& part) const;
    void go_on_without(const DeviceLost& lost);
    void go_back_to_start();
    bool accepts(const Step& step, bool may_repeat, FrameRecord& frame);
    std::optional<StepEstimate> estimate();
    bool iterates_more(double error);
    void iterate_less(double error);
    void tell_of_tolerance(double error);
    void look_at_contact(FrameRecord& frame);
    void look_at_crossings();
    StoredInContacts stored_in_contacts();
    bool goes_on_with(const Alarm& alarm, const Step& step);
    bool halve(const Alarm& alarm);
    void tell(const Alarm& alarm, const std::string& what);

    SimulationOptions options_;
    std::vector<Trouble> troubles_;
    std::shared_ptr<Model> model_;
    std::unique_ptr<Solver> solver_;
    std::unique_ptr<Watch> watch_;
    std::unique_ptr<ErrorSamples> samples_;  ///< null: nothing is estimated
    std::unique_ptr<CrossingChecks>
        crossings_;  ///< null: no contact, or energies are not looked at
    std::unique_ptr<PlannedExecutor> run_;
    std::string async_choice_;
    int first_substeps_ = 0;     ///< that the run began with
    int most_iterations_ = 0;    ///< likewise
    int failed_iterations_ = 0;  ///< that were seen to be too few for the tolerance
    bool tolerance_told_ = false;
    mutable Snapshots snapshots_;
    std::shared_ptr<const SimulationState> start_;  ///< of the frame at hand
    /// Of the present state; null: none was asked for yet.
    mutable std::shared_ptr<const SimulationState> snapshot_;
    std::uint32_t redone_ = 0;  ///< how often the frame at hand was run again for contact
    bool was_redone_ = false;   ///< the frame before it
    int frame_ = 0;
};

}  // namespace weft
