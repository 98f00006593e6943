// Asynchronous iterations on a core and OpenCL devices.

#include "runtime/opencl/opencl_device.h"
#include "tests/simulation/run/async_runs.h"

namespace weft::test {
namespace {

/// Fewer cases: each builds its kernels.
class AsyncBesideOpenCl : public Async {};

TEST_P(AsyncBesideOpenCl, InMemoryOfItsOwn) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    Devices devices = cpus(1);
    DeviceOptions options;
    options.memory = MemoryModel::kDiscrete;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
    expect_same_on_one_device(*simulation(std::move(devices), in_two(), ""));
}

/// Copies, merges and slots of one substep, task by task as kernels: for oclgrind, which cannot run
/// packs of 8, nor a device that waits for another one.
TEST_P(AsyncBesideOpenCl, OneSubstepOfOneLane) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    scene_.substeps = 1;
    scene_.solver.iterations = 3;
    const auto run = simulation(cpus(2), in_two(), "settle=0");
    SimulationOptions options;
    options.devices = "opencl";
    options.device_options.opencl_lanes = 1;
    const RunDescription description = run->describe();
    Replay twin(scene_, options, description, warnings_);
    twin.advance(run->advance());
    EXPECT_EQ(twin.simulation().hash(), run->hash());
}

/// A core and one or two parts of an OpenCL device, more than there may be cores: twenty times the
/// same, and the same as on cores alone.
TEST_P(AsyncBesideOpenCl, AgainAndAgain) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    if (opencl_devices()[0].units < 2) GTEST_SKIP() << "it cannot be divided";
    for (const std::vector<int>& parts : {std::vector{1}, std::vector{1, 1}}) {
        const Division division = parts.size() == 1 ? in_two() : in_three();
        Devices devices = cpus(1);
        for (auto& device : open_opencl_device(0, parts, {})) devices.push_back(std::move(device));
        const auto run = simulation(std::move(devices), division, "");
        const Checkpoint start = run->checkpoint();
        const std::string first = hash_of(*run);
        for (int again = 0; again < 20; ++again) {
            run->resume(start);
            EXPECT_EQ(hash_of(*run), first) << again;
        }
        EXPECT_EQ(hash_of(*simulation(cpus(1 + static_cast<int>(parts.size())), division, "")),
                  first);
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, AsyncBesideOpenCl,
                         testing::Values(AsyncCase{Method::kXpbd, &kEverything},
                                         AsyncCase{Method::kVbd, &kEverything},
                                         AsyncCase{Method::kXpbd, &kSolids},
                                         AsyncCase{Method::kXpbd, &kTouching},
                                         AsyncCase{Method::kVbd, &kTouching}),
                         name_of_case);

}  // namespace
}  // namespace weft::test
