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
    {"VbdEverything", kEverything, Method::kVbd, "451b88df940d1d4e2a16bb01007bd122"},
    {"VbdSolids", kSolids, Method::kVbd, "f9ae76c962e7b08054c0678fcd7bf8bc"},
    {"VbdSewn", kSewn, Method::kVbd, "5c98700890bcc9c80f8b440593bda93d"},
    {"VbdSpringsOnly", kSpringsOnly, Method::kVbd, "62d835603b24d094b9d4812fbfda5720"},
    {"VbdWoven", kWoven, Method::kVbd, "0eb8940f1693287d8006ccc0f9d069db"},
    {"VbdTouching", kTouching, Method::kVbd, "5df725183804cd14d79dd79a2c08a89b"},
    {"VbdLying", kLying, Method::kVbd, "9234e7da93894e4ce6b37c1b14f165af"},
    {"XpbdLying", kLying, Method::kXpbd, "7f411925f7d4f06e634d85d6e626c5bb"},
    {"VbdRubbing", kRubbing, Method::kVbd, "cc51b2a75348e1048e43a11d699d3e43"},
    {"XpbdRubbing", kRubbing, Method::kXpbd, "28faca7362a68a3c54529204ce09c0be"},
    {"XpbdSheets", kSheets, Method::kXpbd, "99c9f900e32b7e82b7064f258a864a67"},
    {"SosdTouching", kTouching, Method::kSosd, "7d621fa0b50841b0d58f685aa337601d"},
    {"JpgdTouching", kTouching, Method::kJpgd, "8d590d40caf174147a0c3e9f62330d54"},
    {"NewtonTouching", kTouching, Method::kNewton, "66988f7debc61aded5e785ac189fe418"},
    {"NewtonRubbing", kRubbing, Method::kNewton, "4e13bfc9b7b543aa6c110d6c36f8cc5f"},
    {"XpbdTouching", kTouching, Method::kXpbd, "648b8e5ba5b73fe7971d424eb3bf67ac"},
    {"SosdEverything", kEverything, Method::kSosd, "4045831abf8211b0450aa397f7e487db"},
    {"SosdSolids", kSolids, Method::kSosd, "10fef327f2878e0379aad77024d248c8"},
    {"SosdSewn", kSewn, Method::kSosd, "752307b91acf0ddb89ae9de382d5410c"},
    {"SosdSpringsOnly", kSpringsOnly, Method::kSosd, "e558a68b3cc596e977e7dbec017c7a58"},
    {"SosdWoven", kWoven, Method::kSosd, "53953cb0789f2724e65d7e037acb2faa"},
    {"JpgdEverything", kEverything, Method::kJpgd, "855a8257a90c8c23dcbdf1a1cb9e4a9a"},
    {"JpgdSolids", kSolids, Method::kJpgd, "2ca3d9957f7ee194e4e96e60fd2aebf0"},
    {"JpgdSewn", kSewn, Method::kJpgd, "59f113ec9c72a6ff1a5161a0fbd9d3f8"},
    {"JpgdSpringsOnly", kSpringsOnly, Method::kJpgd, "3305428e4f7fe610bc5fe46bdcb37050"},
    {"NewtonEverything", kEverything, Method::kNewton, "60e84c3fd882f43abff83b7f83f4eeb0"},
    {"NewtonSolids", kSolids, Method::kNewton, "93e5b4edf7a17cb23677f893804f8e3a"},
    {"NewtonSewn", kSewn, Method::kNewton, "6d8f26ed3a5fde89011b730bc461f1f6"},
    {"NewtonSpringsOnly", kSpringsOnly, Method::kNewton, "add8ea0d7b65c22f1f2706807d1f20fc"},
    {"NewtonWoven", kWoven, Method::kNewton, "22dd2643979b5f45f9b5dc285471953e"},
    {"XpbdNarrow", kNarrowTouching, Method::kXpbd, "5c89ba6f06febe1f775fcbfa47b8a98c"},
    {"VbdNarrow", kNarrow, Method::kVbd, "a377a71739a67cc6c83d17c7a52a59d9"},
    {"SosdNarrow", kNarrow, Method::kSosd, "db504394e36df9c59866a3bb94c9781a"},
    {"JpgdNarrow", kNarrowTouching, Method::kJpgd, "98a43b5ef42efaaa23239c0978dfbe23"},
    {"NewtonNarrow", kNarrowTouching, Method::kNewton, "9861510cd66690dad2e87f000238c9da"},
    {"JpgdWoven", kWoven, Method::kJpgd, "84a22cc7c176365b5e61a383a2cae693"},
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
