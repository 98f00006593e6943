#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/clock.h"
#include "simulation/scene/read_scene.h"
#include "simulation/solver/solver.h"
#include "tests/runtime/planning/virtual_machine.h"

namespace weft::test {

inline constexpr int kSubsteps = 8;

inline Scene sheet(int across, int along) {
    Scene scene = parse_scene(R"(
[scene]
frames = 1
dt = 0.016
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [2, 2] }
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-4 }
)",
                              "test.toml");
    scene.cloths[0].shape = GridShape{{1.0, 1.0}, {across, along}};
    return scene;
}

/// A planner, its solver, and the machine that it plans for.
class Planned {
public:
    /// prepare  to be called before the planner sees the machine for the first time
    Planned(int across, int along, std::vector<VirtualMachine::Speed> speeds, double latency,
            PlanKind kind = PlanKind::kAuto, const std::vector<int>& teams = {},
            std::optional<Division> division = std::nullopt,
            const std::function<void(Planned&)>& prepare = {})
        : model_(sheet(across, along), warnings_),
          solver_(make_solver(model_)),
          machine(std::move(speeds), latency, teams),
          planner(*solver_, model_.strips.count(), machine.devices(), kind, std::move(division)) {
        if (prepare) prepare(*this);
        for (const FramePlan& plan : planner.calibration()) {
            planner.learn(plan, machine.run(plan, 2), 2);
        }
    }

    struct Frame {
        Division division;
        bool placed;
        double lower_bound, planned, measured, plan_time;
        double next_time;  ///< what next() took, seen from outside [s]
    };
    Frame advance() {
        const double start = now();
        const FramePlan& plan = planner.next();
        const double next_time = now() - start;
        const RunTimes times = machine.run(plan, kSubsteps);
        if (gives_up(plan, times)) return advance();
        const Frame frame{plan.division(),
                          plan.is_placed(),
                          plan.lower_bound() * kSubsteps,
                          plan.substep_time() * kSubsteps,
                          times.end - times.start,
                          plan.plan_time,
                          next_time};
        planner.learn(plan, times, kSubsteps);
        return frame;
    }
    Frame advance(int frames) {
        for (int i = 1; i < frames; ++i) advance();
        return advance();
    }
    int strip_count() const { return model_.strips.count(); }

    /// Items of a substep's tasks. [kind]
    std::vector<double> items() const {
        std::vector<double> items(solver_->kinds().size(), 0.0);
        const Step step = solver_->make_step(Partition::whole(strip_count()));
        for (const Task& task : step.tasks()) {
            items[static_cast<std::size_t>(task.body->kind)] += static_cast<double>(task.items);
        }
        return items;
    }

    /// What the devices would take together if they could share anything.
    double ideal() const {
        double speed = 0.0;
        for (const auto& device : machine.speeds) speed += 1.0 / device.per_item;
        const auto all = items();
        return kSubsteps * std::accumulate(all.begin(), all.end(), 0.0) / speed;
    }

    int given_up() const { return given_up_; }

private:
    bool gives_up(const FramePlan& plan, const RunTimes& times) {
        const double first = end_of(0, times), second = end_of(1, times);
        if (second - first <= plan.patience) return false;
        planner.give_up(plan, second - times.start, second - first);
        ++given_up_;
        return true;
    }
    static double end_of(int instance, const RunTimes& times) {
        double end = times.start;
        for (const auto& device : times.tasks) {
            for (const TaskTime& time : device) {
                if (time.instance == instance) end = std::max(end, time.end);
            }
        }
        return end;
    }

    int given_up_ = 0;  ///< frames, in their middle
    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;

public:
    VirtualMachine machine;
    FramePlanner planner;
};

}  // namespace weft::test
