#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/planning/planned_executor.h"
#include "simulation/run/step_choice.h"
#include "simulation/solver/solver.h"
#include "simulation/state/snapshots.h"

namespace weft {

struct FrozenContact;
struct StoredInContacts;

/// A model that is simulated: it, its solver, and the devices they are on. Keeps what these have in
/// step with the host, and what there is to go back to.
class LiveModel {
public:
    using SolverMaker = std::function<std::unique_ptr<Solver>(Model&)>;

    /// At the host alone, until open().
    LiveModel(const Scene& scene, SolverMaker make_solver, std::vector<std::string>& warnings);
    void open(std::vector<std::unique_ptr<Device>> devices, PlanningOptions options);
    /// A substep or two on every device, undone afterwards.
    void calibrate(std::vector<std::string>& warnings);

    Model& model() { return *model_; }
    const Model& model() const { return *model_; }
    const std::shared_ptr<Model>& shared_model() const { return model_; }
    Solver& solver() { return *solver_; }
    /// Null: the scene has none.
    ContactResponse* contact() { return solver_->contact(); }
    PlannedExecutor& planned() { return *planned_; }
    const PlannedExecutor& planned() const { return *planned_; }
    Executor& executor() { return planned_->executor(); }

    /// What moves by itself is placed for the frame that begins at a time [s].
    void place(double time);
    /// Brings the state to the host.
    void fetch();
    /// The host's state, between two frames.
    std::shared_ptr<const SimulationState> snapshot() const;
    /// Goes on from another state.
    void restore(const SimulationState& state);
    /// The same, of which solvers remember nothing. Both in scene order, counted from the origin.
    void start_from(std::span<const float> positions, std::span<const float> velocities);

    // A frame begins with the present state, to which it can go back until it ends.
    void begin_frame();
    const SimulationState& start() const { return *start_; }
    /// To run it again. Also what is no part of the state goes back: contact's candidates are those
    /// of some substep or other.
    void go_back_to_start();
    /// The state in the middle of a frame is lost with the device, so the host has that of the
    /// start; go_back_to_start() shows it to the others. Throws RunError if there is no other.
    void go_on_without(const DeviceLost& lost, int frame);
    void end_frame() { start_.reset(); }

    /// Everything that knows the length of a step is made anew, for the frame that begins at a time
    /// [s]; devices and costs stay. What a solver remembers of substeps of another length is
    /// forgotten.
    void set_steps(Steps steps, double time);
    /// Another solver, by another kind of plan, goes on from here.
    void set_solver(SolverMaker make_solver, PlanKind plan, double time);

    /// That the last substep found where it began; corners in scene order.
    std::vector<FrozenContact> contacts();
    /// By the last frame.
    StoredInContacts stored_in_contacts();

private:
    void show_placed();

    SolverMaker make_solver_;
    std::shared_ptr<Model> model_;
    std::unique_ptr<Solver> solver_;
    std::unique_ptr<PlannedExecutor> planned_;
    mutable Snapshots snapshots_;
    /// Of the present state; null: none was asked for yet.
    mutable std::shared_ptr<const SimulationState> snapshot_;
    std::shared_ptr<const SimulationState> start_;  ///< of the frame at hand
};

}  // namespace weft
