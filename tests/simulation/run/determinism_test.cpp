// The same scene gives the same bits on one core, on any OpenCL device, and on every mixture of
// them.

#include <gtest/gtest.h>

#include "runtime/opencl/opencl_device.h"
#include "runtime/tbb/cpu_device.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"
#include "tests/simulation/run/manual_run.h"
#include "tests/simulation/run/test_scenes.h"

namespace weft::test {
namespace {

constexpr int kFrames = 4;
constexpr int kGradientSteps = 8;  ///< of newton: enough tasks for a test

struct TestScene {
    const char* name;
    const std::string& text;
    Method method;
    /// From cpu/1. When results are meant to change, run this test and copy the new hash from its
    /// message, and say in the change log that results changed.
    const char* hash;
};

const TestScene kScenes[] = {
    {"Everything", kEverything, Method::kXpbd, "4f0878c76cf04b3783d0431c625fa8d1"},
    {"Solids", kSolids, Method::kXpbd, "586ff816adc67f831018e00cfe739134"},
    {"Sewn", kSewn, Method::kXpbd, "4ed99e22ba8e953aafb0b72917a1bf7c"},
    {"SpringsOnly", kSpringsOnly, Method::kXpbd, "877570edce90c2769df725c608bd8224"},
    {"Woven", kWoven, Method::kXpbd, "6ed8bf3030d2df371b10659664f00039"},
    {"VbdEverything", kEverything, Method::kVbd, "07f188ebd562defe764518a805c3b950"},
    {"VbdSolids", kSolids, Method::kVbd, "de4c71a853645a4fce48aad46e9115d4"},
    {"VbdSewn", kSewn, Method::kVbd, "81d51f5c890244a6bc530c1dafb9c2c6"},
    {"VbdSpringsOnly", kSpringsOnly, Method::kVbd, "601b32f5ea67d031565e09100edd2e2b"},
    {"VbdWoven", kWoven, Method::kVbd, "d636f27ba0f14dcba17e327f1b7d8556"},
    {"VbdTouching", kTouching, Method::kVbd, "bd1991e670b1aba97fa2d849e1a12d2f"},
    {"VbdLying", kLying, Method::kVbd, "e406401bb05a8843bb49731c8a4b12bf"},
    {"VbdRubbing", kRubbing, Method::kVbd, "be3efb1427eaf1178a45bf776215fa76"},
    {"XpbdRubbing", kRubbing, Method::kXpbd, "83902fdfd1b9ee90c6e5ff8d910b416b"},
    {"XpbdSheets", kSheets, Method::kXpbd, "307f216486baea61c0f1ddc8f3bd3de1"},
    {"SosdTouching", kTouching, Method::kSosd, "bf4ff28a41fdf38d5606c2a2934ef167"},
    {"JpgdTouching", kTouching, Method::kJpgd, "2b1b5c5c75843e532c82ef7df4ae30d7"},
    {"NewtonTouching", kTouching, Method::kNewton, "b9104df64a3a9882fd3fb7d15a420056"},
    {"NewtonRubbing", kRubbing, Method::kNewton, "17c2baf161f52e2bb5fca74e6871b5ff"},
    {"XpbdTouching", kTouching, Method::kXpbd, "a96a5f8b492f0ecfe267afd7833f6a23"},
    {"SosdEverything", kEverything, Method::kSosd, "5e24033e6703ec1940b87807e071e400"},
    {"SosdSolids", kSolids, Method::kSosd, "a2bb4c8524782cee520a3ce3ecdf7525"},
    {"SosdSewn", kSewn, Method::kSosd, "af2334d38610c1a2f3a9532b8a6cd3bf"},
    {"SosdSpringsOnly", kSpringsOnly, Method::kSosd, "00dfd70c45689a281240dc02e561cdee"},
    {"SosdWoven", kWoven, Method::kSosd, "9af4e47827a60ab9f1d20d4886fbd142"},
    {"JpgdEverything", kEverything, Method::kJpgd, "3b342a679c9122805112371f657ae102"},
    {"JpgdSolids", kSolids, Method::kJpgd, "1b0bb70458a3810dcf2442f01df09080"},
    {"JpgdSewn", kSewn, Method::kJpgd, "732ee6613b85994b6a95b7f05a1ed7da"},
    {"JpgdSpringsOnly", kSpringsOnly, Method::kJpgd, "b5e1dd06c0d5d8291ed21db2e9ebf69d"},
    {"NewtonEverything", kEverything, Method::kNewton, "825fd6e0f559a54e0fb74545dd6161f2"},
    {"NewtonSolids", kSolids, Method::kNewton, "3aada505da74f5c468305b785a47ff3a"},
    {"NewtonSewn", kSewn, Method::kNewton, "6d8f26ed3a5fde89011b730bc461f1f6"},
    {"NewtonSpringsOnly", kSpringsOnly, Method::kNewton, "8a79f65da732063202377187252153fa"},
    {"NewtonWoven", kWoven, Method::kNewton, "638e80b7dffdd4015237f6cfcb416a99"},
    {"XpbdNarrow", kNarrowTouching, Method::kXpbd, "e3b5443f5fafb11fe112237e2523c804"},
    {"VbdNarrow", kNarrow, Method::kVbd, "11974673e0590bb900b1e2459bb43831"},
    {"SosdNarrow", kNarrow, Method::kSosd, "8fecfae01ae3c39d35c2f98e1b8d9acc"},
    {"JpgdNarrow", kNarrowTouching, Method::kJpgd, "6ffa3702f639c6c439ef8bdfb0d114e3"},
    {"NewtonNarrow", kNarrowTouching, Method::kNewton, "0fd9eacf48a0637ed9ceebdd2ab415c2"},
    {"JpgdWoven", kWoven, Method::kJpgd, "07f820a0af9a8e04d2f4773335a1bb4b"},
};

const TestScene& scene(std::string_view name) {
    return *std::ranges::find(kScenes, name, &TestScene::name);
}

std::vector<std::unique_ptr<Device>> opened(std::initializer_list<MemoryModel> opencl, int cpus) {
    std::vector<std::unique_ptr<Device>> devices;
    for (int i = 0; i < cpus; ++i) devices.push_back(make_cpu_device(1, {}));
    for (const MemoryModel memory : opencl) {
        DeviceOptions options;
        options.memory = memory;
        for (auto& device : open_opencl_device(0, {}, options))
            devices.push_back(std::move(device));
    }
    return devices;
}

class Determinism : public testing::TestWithParam<TestScene> {
protected:
    Determinism() : scene_(parse_scene(GetParam().text, "test.toml")) {
        scene_.solver.method = GetParam().method;
        scene_.solver.cg_steps = kGradientSteps;
    }

    std::string hash_on(const std::string& devices, const DeviceOptions& options = {},
                        PlanKind plan = PlanKind::kAuto) {
        Warnings warnings;
        SimulationOptions settings;
        settings.devices = devices;
        settings.device_options = options;
        settings.plan = plan;
        Simulation simulation(scene_, settings, warnings);
        for (int frame = 0; frame < kFrames; ++frame) simulation.advance();
        return simulation.hash();
    }

    /// Expects the known hash for each division of the strips among two devices.
    void expect_same_for_every_cut(std::vector<std::unique_ptr<Device>> devices) {
        ManualRun run(scene_, std::move(devices));
        ASSERT_GE(run.strip_count(), 5) << "too few strips to say anything";
        for (int cut = 0; cut <= run.strip_count(); ++cut) {
            run.reset();
            run.run(kFrames, Division{{cut, run.strip_count() - cut}});
            ASSERT_EQ(run.hash(), GetParam().hash) << "cut at strip " << cut;
        }
    }

    Scene scene_;
};

DeviceOptions as_gpus(EntryStyle style) {
    DeviceOptions options;
    options.opencl_lanes = 1;
    options.entry_style = style;
    options.group_size = 16;
    return options;
}

class OpenClDeterminism : public Determinism {
protected:
    void SetUp() override {
        // All devices, before any list limits what the process sees of them.
        if (opencl_devices().empty()) GTEST_SKIP() << "no OpenCL device here";
    }
};

TEST_P(Determinism, KnownHashOnOneThread) { EXPECT_EQ(hash_on("cpu/1"), GetParam().hash); }

TEST_P(Determinism, TwoThreads) {
    ManualRun run(scene_, [] {
        std::vector<std::unique_ptr<Device>> devices;
        devices.push_back(make_cpu_device(2, {}));
        return devices;
    }());
    run.run(kFrames);
    EXPECT_EQ(run.hash(), GetParam().hash);
    EXPECT_EQ(hash_on("cpu"), GetParam().hash);
}

TEST_P(Determinism, ScalarKernelsAndPacksOfAllWidths) {
    for (const int lanes : {1, 8, 16}) {
        DeviceOptions options;
        options.cpu_lanes = lanes;
        EXPECT_EQ(hash_on("cpu/1", options), GetParam().hash) << lanes << " lanes";
    }
}

TEST_P(Determinism, EveryCutBetweenTwoCpuDevices) { expect_same_for_every_cut(opened({}, 2)); }

TEST_P(OpenClDeterminism, Alone) {
    EXPECT_EQ(hash_on("opencl:0/1"), GetParam().hash);
    EXPECT_EQ(hash_on("opencl:0"), GetParam().hash);
}

TEST_P(OpenClDeterminism, EntryPointsOfGpus) {
    DeviceOptions options = as_gpus(EntryStyle::kPerGroup);
    EXPECT_EQ(hash_on("opencl:0", options), GetParam().hash);
    options.memory = MemoryModel::kDiscrete;
    EXPECT_EQ(hash_on("opencl:0", options), GetParam().hash);
}

/// What has too many parameters for a group.
class OpenClColours : public OpenClDeterminism {};

TEST_P(OpenClColours, HaveTheBitsOfStrips) {
    EXPECT_EQ(hash_on("opencl:0", as_gpus(EntryStyle::kPerColour)), GetParam().hash);
}

/// Every kernel of the scene, strip by strip and by groups. Small enough for oclgrind, which
/// cannot run packs of 8.
TEST_P(OpenClDeterminism, OneSubstepOfOneLane) {
    scene_.solver.iterations = 2;
    const auto hash_on = [&](std::vector<std::unique_ptr<Device>> devices) {
        ManualRun run(scene_, std::move(devices));
        run.run_substeps(1);
        return run.hash();
    };
    const std::string expected = hash_on(opened({}, 1));
    DeviceOptions options;
    options.opencl_lanes = 1;
    EXPECT_EQ(hash_on(open_opencl_device(0, {}, options)), expected) << "strips";
    options = as_gpus(EntryStyle::kPerGroup);
    EXPECT_EQ(hash_on(open_opencl_device(0, {}, options)), expected) << "groups";
}

TEST_P(OpenClDeterminism, EveryMixtureThatAPlannerMakes) {
    for (const PlanKind plan :
         {PlanKind::kAuto, PlanKind::kExact, PlanKind::kPlaced, PlanKind::kSingle}) {
        EXPECT_EQ(hash_on("cpu/1+opencl:0/1", {}, plan), GetParam().hash);
    }
    EXPECT_EQ(hash_on("opencl:0/1+cpu/1", {}, PlanKind::kExact), GetParam().hash);
    EXPECT_EQ(hash_on("opencl:0/1+opencl:0/1", {}, PlanKind::kExact), GetParam().hash);
    EXPECT_EQ(hash_on("hybrid"), GetParam().hash);
    for (const MemoryModel memory : {MemoryModel::kDiscrete, MemoryModel::kMapped}) {
        DeviceOptions options;
        options.memory = memory;
        EXPECT_EQ(hash_on("cpu/1+opencl:0/1", options, PlanKind::kExact), GetParam().hash);
        EXPECT_EQ(hash_on("cpu/1+opencl:0/1", options, PlanKind::kPlaced), GetParam().hash);
    }
}

TEST_P(OpenClDeterminism, EveryCutBetweenTheCpuAndAnyMemory) {
    for (const MemoryModel memory :
         {MemoryModel::kHost, MemoryModel::kDiscrete, MemoryModel::kMapped}) {
        SCOPED_TRACE(name_of(memory));
        expect_same_for_every_cut(opened({memory}, 1));
    }
}

TEST_P(OpenClDeterminism, EveryDivisionAmongThreeDevices) {
    ManualRun run(scene_, opened({MemoryModel::kDiscrete, MemoryModel::kDiscrete}, 1));
    const int strips = run.strip_count();
    std::string expected;
    for (int first = 0; first <= strips; ++first) {
        for (int second = 0; second <= strips - first; ++second) {
            run.reset();
            run.run(1, Division{{first, second, strips - first - second}});
            if (first + second == 0) expected = run.hash();
            ASSERT_EQ(run.hash(), expected) << first << " + " << second << " strips";
        }
    }
}

std::string name_of_scene(const testing::TestParamInfo<TestScene>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism, testing::ValuesIn(kScenes), name_of_scene);
INSTANTIATE_TEST_SUITE_P(Scenes, OpenClDeterminism, testing::ValuesIn(kScenes), name_of_scene);
INSTANTIATE_TEST_SUITE_P(Scenes, OpenClColours,
                         testing::Values(scene("XpbdTouching"), scene("NewtonRubbing"),
                                         scene("JpgdEverything")),
                         name_of_scene);

class DeterminismScene : public testing::TestWithParam<TestScene> {};

TEST_P(DeterminismScene, TouchesAllObstacles) {
    // Each obstacle taken away changes the outcome, so none is there for nothing.
    Scene whole = parse_scene(GetParam().text, "test.toml");
    whole.solver.method = GetParam().method;
    whole.solver.cg_steps = kGradientSteps;
    ManualRun all(whole);
    all.run(kFrames);
    for (std::size_t i = 0; i < whole.obstacles.size(); ++i) {
        Scene scene = whole;
        scene.obstacles.erase(scene.obstacles.begin() + static_cast<std::ptrdiff_t>(i));
        ManualRun run(scene);
        run.run(kFrames);
        EXPECT_NE(run.hash(), all.hash()) << whole.obstacles[i].shape;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeterminismScene, testing::ValuesIn(kScenes), name_of_scene);

}  // namespace
}  // namespace weft::test
