#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device_list.h"
#include "runtime/trace/records.h"
#include "simulation/planning/division.h"
#include "simulation/planning/plan_kind.h"
#include "simulation/solver/solver.h"

namespace weft {

class Executor;
class FramePlanner;
struct FramePlan;
struct RunTimes;

struct SimulationOptions {
    std::string devices = "hybrid";
    PlanKind plan = PlanKind::kAuto;
    DeviceOptions device_options;
    std::optional<Division> division;  ///< fixed instead of planned
};

/// A scene on devices, frame by frame. The results do not depend on the devices or on the plans.
class Simulation {
public:
    /// Throws UserError for a scene or devices that cannot be had.
    Simulation(const Scene& scene, const SimulationOptions& options, Warnings& warnings);
    ~Simulation();

    /// Simulates the next frame: plans, runs all substeps, checks the state, measures energies.
    /// Throws RunError if a device failed or the state went bad; then the state is that of the
    /// frame's start.
    FrameRecord advance();

    int frame() const { return frame_; }  ///< the next one
    const Model& model() const { return *model_; }
    const Solver& solver() const { return *solver_; }
    const std::vector<std::unique_ptr<Device>>& devices() const { return devices_; }
    const FramePlanner& planner() const { return *planner_; }

    /// For traces: everything that is known before the first frame but the command line.
    RunDescription describe() const;

    /// xyz of all vertices in scene order [m], [m/s].
    std::vector<float> positions() const;
    std::vector<float> velocities() const;
    std::string hash() const;

private:
    struct State {
        std::vector<float4> positions, velocities;
        std::vector<std::vector<std::byte>> solver;  ///< as Solver::state()
    };
    State save() const;
    void restore(const State& state);

    double frame_time() const { return frame_ * model_->scene.dt; }
    void place();
    void calibrate();
    void fetch();
    FrameRecord record(const FramePlan& plan, const RunTimes& times) const;
    /// Runs the frame again from its start, task by task, to the first bad value; throws.
    [[noreturn]] void diagnose(const State& start);

    std::vector<std::unique_ptr<Device>> devices_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<Solver> solver_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<FramePlanner> planner_;
    int frame_ = 0;
};

}  // namespace weft
