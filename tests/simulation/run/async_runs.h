#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/tbb/cpu_device.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/test_scenes.h"

/// Asynchronous runs of a small scene, and what they have to be the same as.
namespace weft::test {

inline constexpr int kFrames = 3;

using Devices = std::vector<std::unique_ptr<Device>>;

inline Devices cpus(int count) {
    Devices devices;
    for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}));
    return devices;
}

struct AsyncCase {
    Method method;
    const std::string* scene;
    int iterations = 5;
};

inline std::string name_of_case(const testing::TestParamInfo<AsyncCase>& info) {
    std::string name(name_of(info.param.method));
    const bool touches = info.param.scene == &kTouching;
    name += info.param.scene == &kSolids ? "Solids" : touches ? "Touching" : "Everything";
    return name + std::to_string(info.param.iterations);
}

class Async : public testing::TestWithParam<AsyncCase> {
protected:
    Async() : scene_(parse_scene(*GetParam().scene, "test.toml")) {
        scene_.solver.method = GetParam().method;
        scene_.solver.iterations = GetParam().iterations;
        strips_ = Model(scene_, warnings_).strips.count();
    }
    std::unique_ptr<Simulation> simulation(Devices devices, const Division& division,
                                           const std::string& settings) {
        SimulationOptions options;
        options.division = division;
        options.plan = PlanKind::kAsync;
        options.async = parse_async_settings(allowed(settings));
        options.calibrate = false;
        return std::make_unique<Simulation>(scene_, std::move(devices), options, warnings_);
    }
    /// With contact at least the last iteration is in step.
    std::string allowed(std::string settings) const {
        const std::size_t at = settings.find("settle=0");
        if (scene_.contact && at != std::string::npos) settings.erase(at > 0 ? at - 1 : 0);
        return settings;
    }
    static std::string hash_of(Simulation& run) {
        for (int frame = 0; frame < kFrames; ++frame) run.advance();
        return run.hash();
    }
    std::string synchronous_hash() {
        SimulationOptions options;
        options.division = Division{{strips_}};
        options.calibrate = false;
        Simulation run(scene_, cpus(1), options, warnings_);
        return hash_of(run);
    }
    Division in_two() const { return {{strips_ / 2, strips_ - strips_ / 2}}; }
    Division in_three() const { return {{1, strips_ - 2, 1}}; }

    /// Task by task on one device, by the same map.
    void expect_same_on_one_device(Simulation& run) {
        const RunDescription description = run.describe();
        SimulationOptions options;
        options.devices = "cpu/1";
        Replay twin(scene_, options, description, warnings_);
        for (int frame = 0; frame < kFrames; ++frame) {
            twin.advance(run.advance());
            EXPECT_EQ(twin.simulation().hash(), run.hash()) << frame;
        }
    }

    Scene scene_;
    Warnings warnings_;
    int strips_ = 0;
};

}  // namespace weft::test
