#include <benchmark/benchmark.h>

#include <bit>
#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/frame_planner.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/scene/read_scene.h"
#include "simulation/solver/solver.h"

// What planning a frame of the shipped scenes takes: two devices that are alike, so that their
// mixture is divided anew; and two that are good at different kinds of tasks, so that tasks are
// placed one by one. Costs change a little every frame, as measured ones do. The time is what
// the planner says of itself, without its first frames, in which it makes graphs.
namespace {

using namespace weft;

constexpr int kFirstFrames = 60;

/// What a planner needs to plan a scene.
class Planned {
public:
    /// size  of the scene [vertices]; 0: as it is shipped
    Planned(const std::string& scene, int size)
        : model_(read_scene(std::string(WEFT_SCENES) + "/" + scene + ".toml", sized(size)),
                 warnings_),
          solver_(make_solver(model_)) {
        for (int d = 0; d < 2; ++d) devices_.push_back(make_cpu_device(1, {}));
        planner_ = std::make_unique<FramePlanner>(*solver_, model_.strips.count(), pointers(),
                                                  PlanKind::kAuto);
    }

    /// by_kind  how much dearer the second device is at every second kind, and cheaper at others
    void set_costs(double by_kind, int frame) {
        auto& costs = planner_->timing().costs();
        const double noise = 1.0 + 0.01 * ((frame * 7) % 5);
        for (std::uint32_t kind = 0; kind < costs.kinds(); ++kind) {
            const double factor = kind % 2 == 1 ? by_kind : 1.0 / by_kind;
            costs.restore(kind, 0, {{2e-6, 10e-9 * noise}, 0.1, 20});
            costs.restore(kind, 1, {{2e-6, 10e-9 * factor}, 0.1, 20});
        }
    }

    const FramePlan& next() { return planner_->next(); }

private:
    static std::vector<Override> sized(int size) {
        if (size == 0) return {};
        return {{"scene.size=" + std::to_string(size), "size"}};
    }
    std::vector<Device*> pointers() const {
        std::vector<Device*> list;
        for (const auto& device : devices_) list.push_back(device.get());
        return list;
    }

    Warnings warnings_;
    Model model_;
    std::unique_ptr<Solver> solver_;
    std::vector<std::unique_ptr<Device>> devices_;
    std::unique_ptr<FramePlanner> planner_;
};

void plan_frames(benchmark::State& state, const std::string& scene, int size, double by_kind) {
    Planned planned(scene, size);
    int frame = 0;
    for (; frame < kFirstFrames; ++frame) {
        planned.set_costs(by_kind, frame);
        planned.next();
    }
    int placed = 0;
    int devices = 0;
    for (auto _ : state) {
        planned.set_costs(by_kind, frame++);
        const FramePlan& plan = planned.next();
        state.SetIterationTime(plan.plan_time);
        placed += plan.is_placed() ? 1 : 0;
        devices += std::popcount(plan.devices());
    }
    const auto mean = [](int sum) {
        return benchmark::Counter(static_cast<double>(sum), benchmark::Counter::kAvgIterations);
    };
    state.counters["placed"] = mean(placed);
    state.counters["devices"] = mean(devices);
}

void add(const std::string& scene, int size, double by_kind) {
    const std::string name = "BM_Plan/" + scene + (size > 0 ? "/" + std::to_string(size) : "") +
                             (by_kind > 1.0 ? "/by_kind" : "/alike");
    benchmark::RegisterBenchmark(name.c_str(), plan_frames, scene, size, by_kind)
        ->UseManualTime()
        ->Iterations(200)
        ->Unit(benchmark::kMicrosecond);
}

const bool registered = [] {
    for (const double by_kind : {1.0, 5.0}) {
        for (const char* scene : {"beams", "flag", "hammock", "sheet", "skirt", "tablecloth"}) {
            add(scene, 0, by_kind);
        }
        add("tablecloth", 40000, by_kind);
    }
    return true;
}();

}  // namespace
