#include "simulation/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace weft {

namespace {

constexpr int kMostIterates = 31;  // OwnIterates keeps a bit for each

int recorded_iterates(const RunDescription& run) {
    int iterates = 1;
    for (const auto& [name, value] : run.settings) {
        if (name != "iterates") continue;
        std::from_chars(value.data(), value.data() + value.size(), iterates);
    }
    return std::clamp(iterates, 1, kMostIterates);
}

SimulationOptions without_planning(const SimulationOptions& options, const RunDescription& run) {
    SimulationOptions own;
    own.devices = options.devices;
    own.device_options = options.device_options;
    own.calibrate = false;
    own.iterates = recorded_iterates(run);
    for (const auto& [name, value] : run.settings) {
        if (name != "async") continue;
        own.plan = PlanKind::kAsync;
        own.async = parse_async_settings(value);
    }
    own.on_trouble = OnTrouble::kReport;  // the run went on, too
    own.on_crossing = OnCrossing::kWarn;
    return own;
}

}  // namespace

Replay::Replay(const Scene& scene, const SimulationOptions& options, const RunDescription& recorded,
               Warnings& warnings)
    : simulation_(scene, without_planning(options, recorded), warnings),
      plans_(
          recorded, simulation_.model().strips.count(),
          [this](const Division& division) { return simulation_.make_step(division); },
          [this](const Task& task) { return simulation_.planner().timing().items_vary(task); }) {}

void Replay::advance(const FrameRecord& recorded) {
    if (static_cast<int>(recorded.frame) != simulation_.frame()) {
        refuse_replay(recorded.frame,
                      fmt::format("frame {} is not in the trace", simulation_.frame()));
    }
    const Scene& scene = simulation_.model().scene;
    const auto or_as_now = [](std::uint32_t number, int now) {
        return number > 0 ? static_cast<int>(number) : now;
    };
    const int substeps = or_as_now(recorded.substeps, scene.substeps);
    const int iterations = or_as_now(recorded.iterations, scene.solver.iterations);
    if (substeps != scene.substeps || iterations != scene.solver.iterations) {
        simulation_.set_steps(substeps, iterations);
        plans_.forget_steps();
    }
    const auto [step, plan] = plans_.plan_of(recorded, simulation_.devices().size());
    simulation_.advance_by(*step, plan);
}

}  // namespace weft
