// Tables that are filled anew in every substep: whatever room they begin with, and whatever devices
// fill them, the results are the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "runtime/device_list.h"
#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/replay.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/failing_device.h"
#include "tests/simulation/run/neighbour_solver.h"

namespace weft::test {
namespace {

/// Sheets of points that fall onto one that is held: the deeper they fall the more neighbours they
/// have, from substep to substep.
const std::string kFallingSheets = R"(
[scene]
frames = 6
dt = 0.04
substeps = 4
[[cloth]]
name = "held"
grid = { size = [0.8, 1.6], resolution = [9, 25] }
density = 0.2
stretch = { stiffness = 1.0 }
pins = { box = [[-9.0, -9.0, -9.0], [9.0, 9.0, 9.0]] }
[[cloth]]
name = "low"
grid = { size = [0.8, 1.6], resolution = [10, 28] }
translate = [0.0, 0.22, 0.0]
density = 0.2
stretch = { stiffness = 1.0 }
[[cloth]]
name = "high"
grid = { size = [0.5, 1.0], resolution = [12, 25] }
translate = [0.1, 0.35, 0.1]
density = 0.2
stretch = { stiffness = 1.0 }
)";

constexpr float kRadius = 0.15f;
constexpr int kFrames = 6;
constexpr int kPlenty = 500;

using Devices = std::vector<std::unique_ptr<Device>>;

class GrowingTables : public testing::Test {
protected:
    /// room: of the rows at the beginning
    std::unique_ptr<Simulation> simulation(Devices devices, int room) {
        SimulationOptions options;
        options.plan = PlanKind::kExact;
        options.make_solver = [&](Model& model) {
            auto solver = std::make_unique<NeighbourSolver>(model, kRadius, room);
            solver_ = solver.get();
            return solver;
        };
        return std::make_unique<Simulation>(scene_, std::move(devices), options, warnings_);
    }
    std::string hash_of(Devices devices, int room) {
        const auto run = simulation(std::move(devices), room);
        for (int frame = 0; frame < kFrames; ++frame) run->advance();
        generation_ = generation();
        return run->hash();
    }
    /// Of the simulation at hand.
    int generation() const { return solver_->tables().front()->generation(); }

    Scene scene_ = parse_scene(kFallingSheets, "falling.toml");
    Warnings warnings_;
    NeighbourSolver* solver_ = nullptr;  ///< of the last simulation, while it is there
    int generation_ = 0;                 ///< at the end of the last hash_of()
};

Devices cpus(int count, int lanes = 0) {
    Devices devices;
    for (int d = 0; d < count; ++d) devices.push_back(make_cpu_device(1, {}, lanes));
    return devices;
}

void add_opencl(Devices& devices, MemoryModel memory, int lanes, EntryStyle style) {
    DeviceOptions options;
    options.memory = memory;
    options.opencl_lanes = lanes;
    options.entry_style = style;
    options.group_size = 16;
    for (auto& device : open_opencl_device(0, {}, options)) devices.push_back(std::move(device));
}

TEST_F(GrowingTables, EveryRoomGivesTheSameBits) {
    const std::string expected = hash_of(cpus(1), kPlenty);
    ASSERT_EQ(generation_, 0) << "there is not plenty of room";
    for (const int room : {0, 1, 2, 3, 5, 8, 13, 21, 34}) {
        EXPECT_EQ(hash_of(cpus(1), room), expected) << room;
        EXPECT_GT(generation_, 0) << room;
    }
}

/// It is not only the first frame that runs again.
TEST_F(GrowingTables, TheyGrowWhenMoreIsNeeded) {
    const auto run = simulation(cpus(1), 1);
    std::vector<int> generations{generation()};
    for (int frame = 0; frame < kFrames; ++frame) {
        run->advance();
        generations.push_back(generation());
    }
    EXPECT_GT(generations[0], 0) << "the calibration fills tables, too";
    EXPECT_GT(generations.back(), generations[1]);
    EXPECT_EQ(run->frame(), kFrames);
}

TEST_F(GrowingTables, ScalarPackedAndMixed) {
    const std::string expected = hash_of(cpus(1), kPlenty);
    for (const int room : {0, 6, kPlenty}) {
        EXPECT_EQ(hash_of(cpus(1, 1), room), expected) << "scalar, room " << room;
        EXPECT_EQ(hash_of(cpus(2), room), expected) << "two devices, room " << room;
    }
}

TEST_F(GrowingTables, OnOpenClOfEveryKind) {
    if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    const std::string expected = hash_of(cpus(1), kPlenty);
    for (const MemoryModel memory :
         {MemoryModel::kHost, MemoryModel::kMapped, MemoryModel::kDiscrete}) {
        for (const int lanes : {1, 8}) {
            for (const EntryStyle style : {EntryStyle::kPerStrip, EntryStyle::kPerGroup}) {
                SCOPED_TRACE(testing::Message()
                             << name_of(memory) << ", " << lanes << " lanes, "
                             << (style == EntryStyle::kPerGroup ? "groups" : "strips"));
                for (const int room : {0, 6}) {
                    Devices alone;
                    add_opencl(alone, memory, lanes, style);
                    EXPECT_EQ(hash_of(std::move(alone), room), expected);
                    Devices mixed = cpus(1);
                    add_opencl(mixed, memory, lanes, style);
                    EXPECT_EQ(hash_of(std::move(mixed), room), expected);
                    EXPECT_GT(generation_, 0);
                }
            }
        }
    }
}

/// Whoever goes back does so because something went wrong, and may have left no numbers.
TEST_F(GrowingTables, WhatGoesBackFindsNoEntries) {
    const auto run = simulation(cpus(1), kPlenty);
    run->advance();
    const Checkpoint checkpoint = run->checkpoint();
    run->advance();
    const auto columns = solver_->tables().front()->resized_buffers();
    ASSERT_FALSE(columns.empty());
    for (BufferStorage* column : columns) std::memset(column->host(), 0xff, column->bytes());
    run->resume(checkpoint);
    for (BufferStorage* column : columns) {
        const auto* bytes = static_cast<const unsigned char*>(column->host());
        EXPECT_TRUE(std::all_of(bytes, bytes + column->bytes(), [](int b) { return b == 0; }))
            << column->name();
    }
}

/// Both ways to begin a frame again, in one frame.
TEST_F(GrowingTables, WhereADeviceIsLost) {
    const std::string expected = hash_of(cpus(1), kPlenty);
    for (int batches = 6; batches < 16; ++batches) {
        Devices devices = cpus(1);
        devices.push_back(make_failing_device(make_cpu_device(1, {}), {batches}));
        EXPECT_EQ(hash_of(std::move(devices), 0), expected) << batches;
    }
}

TEST_F(GrowingTables, AFrameByAPlanFromElsewhereRunsAgain) {
    const std::string expected = hash_of(cpus(1), kPlenty);
    SimulationOptions options;
    options.calibrate = false;
    options.make_solver = [](Model& model) {
        return std::make_unique<NeighbourSolver>(model, kRadius, 0);
    };
    Simulation run(scene_, cpus(1), options, warnings_);
    const int strips = run.model().strips.count();
    const Step step = run.make_step(Division::single(1, strips, 0));
    scheduler::Plan plan;
    for (std::size_t t = 0; t < step.tasks().size(); ++t) {
        const auto start = static_cast<double>(t);
        plan.placements.push_back({start, start + 1.0, 0});
    }
    plan.order_by_start(1);
    for (int frame = 0; frame < kFrames; ++frame) run.advance_by(step, plan);
    EXPECT_EQ(run.hash(), expected);
}

}  // namespace
}  // namespace weft::test
