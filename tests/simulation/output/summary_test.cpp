#include "simulation/output/summary_builder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/error.h"
#include "simulation/output/state_hash.h"

namespace weft {
namespace {

RunDescription two_devices() {
    RunDescription run;
    run.scene_name = "sheet";
    run.devices = {{"CPU", "tbb", "", 1, "host", true}, {"GPU", "opencl", "", 4, "host", true}};
    run.energies = {"spring"};
    return run;
}

/// Frame i takes i + 1 ms, of which planning is 10 us; planned 10 % too low.
FrameRecord frame(std::uint32_t i) {
    FrameRecord frame;
    frame.frame = i;
    frame.sim_time = 0.01 * (i + 1);
    frame.start = i;
    frame.end = i + 1e-3 * (i + 1);
    frame.measured_makespan = 1.1e-3 * (i + 1);
    frame.planned_makespan = 1.0e-3 * (i + 1);
    frame.lower_bound = 0.5e-3 * (i + 1);
    frame.plan_time = 10e-6;
    frame.execute_time = 0.95e-3 * (i + 1);
    frame.transferred_bytes = 1000;
    frame.busy = {1.1e-3 * (i + 1), 0.55e-3 * (i + 1)};
    frame.kinetic_energy = 3.0;
    frame.gravity_energy = -1.0;
    frame.energies = {0.5};
    frame.work = 0.5 * i;
    frame.dissipated = 0.25 * i;
    frame.gained = i == 6 ? 0.125 : i == 9 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    frame.strain_rms = i == 7 ? 0.3 : 0.01;
    frame.strain_max = i == 5 ? 0.8 : 0.02;
    return frame;
}

RunSummary twenty_frames() {
    SummaryBuilder builder(two_devices());
    for (std::uint32_t i = 0; i < 20; ++i) builder.add(frame(i));
    RunSummary summary = builder.summary();
    summary.state_hash = "00ff";
    summary.files = {{"trace", "out/sheet/trace.h5"}};
    return summary;
}

TEST(Summary, CountsOverFrames) {
    const RunSummary summary = twenty_frames();
    EXPECT_EQ(summary.frames, 20U);
    EXPECT_DOUBLE_EQ(summary.simulated_time, 0.2);
    EXPECT_NEAR(summary.wall_time, 19.02, 1e-12);
    EXPECT_NEAR(summary.frame_median, 10e-3, 1e-12);
    EXPECT_NEAR(summary.frame_p95, 19e-3, 1e-12);
    EXPECT_NEAR(summary.plan_error, 0.1, 1e-12);
    EXPECT_NEAR(summary.devices[0].utilisation, 1.0, 1e-12);
    EXPECT_NEAR(summary.devices[1].utilisation, 0.5, 1e-12);
    EXPECT_NEAR(summary.utilisation, 0.75, 1e-12);
    EXPECT_EQ(summary.transferred_bytes, 20000U);
    EXPECT_EQ(summary.energies.back().first, "total");
    EXPECT_DOUBLE_EQ(summary.energies.back().second, 2.5);
    EXPECT_EQ(summary.work, 9.5);
    EXPECT_EQ(summary.dissipated, 4.75);
    EXPECT_EQ(summary.gained, 0.125);
    EXPECT_EQ(summary.gained_frame, 6U);
    EXPECT_EQ(summary.strain_rms, 0.3);
    EXPECT_EQ(summary.strain_frame, 7U);
    EXPECT_EQ(summary.strain_max, 0.8);
    EXPECT_EQ(summary.strain_rms_at_end, 0.01);
}

TEST(Summary, GoesOnFromWhatWasSaved) {
    SummaryBuilder first(two_devices());
    for (std::uint32_t i = 0; i < 8; ++i) first.add(frame(i));
    SummaryBuilder second(two_devices());
    second.restore(first.save());
    EXPECT_EQ(second.end(), first.end());
    for (std::uint32_t i = 8; i < 20; ++i) second.add(frame(i));
    RunSummary summary = second.summary();
    summary.state_hash = "00ff";
    summary.files = {{"trace", "out/sheet/trace.h5"}};
    EXPECT_EQ(to_json(summary), to_json(twenty_frames()));
}

TEST(Summary, KeepsTheRowsOfDevicesThatAreGone) {
    SummaryBuilder first(two_devices());
    first.add(frame(0));
    RunDescription other = two_devices();
    other.devices = {{"GPU", "opencl", "", 4, "host", true}};
    SummaryBuilder second(other);
    second.restore(first.save());
    const RunSummary summary = second.summary();
    ASSERT_EQ(summary.devices.size(), 2U);
    EXPECT_EQ(summary.devices[0].name, "GPU");
    EXPECT_DOUBLE_EQ(summary.devices[0].busy, 0.55e-3);
    EXPECT_EQ(summary.devices[1].name, "CPU");
    EXPECT_DOUBLE_EQ(summary.devices[1].busy, 1.1e-3);
}

TEST(Summary, WhatWasNotSavedByOneIsRefused) {
    std::vector<std::uint8_t> saved = SummaryBuilder(two_devices()).save();
    saved.pop_back();
    EXPECT_THROW(SummaryBuilder(two_devices()).restore(saved), UserError);
    EXPECT_THROW(SummaryBuilder(two_devices()).restore({}), UserError);
}

TEST(Summary, JsonHasTheKeysOfTheContract) {
    const auto json = to_json(twenty_frames());
    for (const char* key :
         {"frames", "ms_per_frame", "ms_p95", "devices", "utilisation", "planned_ms", "measured_ms",
          "plan_us", "transferred_bytes", "energy", "state_hash", "files"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_NEAR(json["plan_us"].get<double>(), 10.0, 1e-9);
    EXPECT_NEAR(json["parts_ms"]["planning"].get<double>(), 0.01, 1e-12);
    EXPECT_NEAR(json["parts_ms"]["executing"].get<double>(), 9.5, 1e-12);
    EXPECT_EQ(json["state_hash"], "00ff");
}

TEST(Summary, TextNamesWhatCounts) {
    const std::string text = to_text(twenty_frames());
    for (const char* part :
         {"20 (0.2 s simulated)", "median 10.000 ms, p95 19.000 ms", "GPU (opencl, 4 units)",
          "50.0 % of the makespan", "20.0 kB", "total 2.5 J", "00ff", "out/sheet/trace.h5"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }
}

TEST(Summary, RunWithoutFramesIsNoDivisionByZero) {
    const RunSummary summary = SummaryBuilder(two_devices()).summary();
    EXPECT_EQ(summary.utilisation, 0.0);
    EXPECT_EQ(to_json(summary)["ms_per_frame"], 0.0);
    EXPECT_FALSE(to_text(summary).empty());
}

TEST(Summary, FileIsWrittenWholeOrNotAtAll) {
    const auto path = std::filesystem::path(testing::TempDir()) / "weft_summary.json";
    write_summary(path, twenty_frames());
    std::ifstream stream(path);
    EXPECT_EQ(nlohmann::json::parse(stream)["frames"], 20);
    std::filesystem::remove(path);
    const auto missing =
        std::filesystem::path(testing::TempDir()) / "weft_missing" / "summary.json";
    try {
        write_summary(missing, twenty_frames());
        FAIL();
    } catch (const RunError& error) {
        EXPECT_EQ(error.what(),
                  missing.string() + ": cannot write the summary: No such file or directory");
    }
}

TEST(StateHash, IsTheSameOnEveryMachine) {
    const std::vector<float> positions = {0.0F, 1.0F, -2.5F, 3.0F, 4.0F, 5.0F};
    const std::vector<float> velocities = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
    EXPECT_EQ(state_hash(positions, velocities), "a6331bb9459732baa23b2011504dae77");
    EXPECT_EQ(state_hash({}, {}), "8eae55a53adb7034863d54dfc16944fe");
}

TEST(StateHash, IsTheSameInEveryOrderOfRows) {
    const std::vector<float4> positions = {{3.0F, 4.0F, 5.0F, 7.0F}, {0.0F, 1.0F, -2.5F, 8.0F}};
    const std::vector<float4> velocities = {{0.4F, 0.5F, 0.6F, 0.0F}, {0.1F, 0.2F, 0.3F, 1.0F}};
    const std::vector<int> rows = {1, 0};
    EXPECT_EQ(state_hash(rows, positions, velocities), "a6331bb9459732baa23b2011504dae77");
}

TEST(StateHash, SeesEveryBit) {
    std::vector<float> positions = {0.0F, 1.0F, 2.0F};
    const std::vector<float> velocities = {0.0F, 0.0F, 0.0F};
    const std::string before = state_hash(positions, velocities);
    EXPECT_EQ(before.size(), 32U);
    positions[0] = -0.0F;
    EXPECT_NE(state_hash(positions, velocities), before);
    positions[0] = 0.0F;
    std::swap(positions[1], positions[2]);
    EXPECT_NE(state_hash(positions, velocities), before);
    std::swap(positions[1], positions[2]);
    EXPECT_NE(state_hash(velocities, positions), before);
    EXPECT_EQ(state_hash(positions, velocities), before);
}

}  // namespace
}  // namespace weft
