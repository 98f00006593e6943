// Costs that one run learns, and the next one starts from.

#include "runtime/planning/saved_costs.h"
#include "simulation/solver/solver.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/joining_thread.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class DescribedDevice final : public Device {
public:
    explicit DescribedDevice(DeviceInfo info) : info_(std::move(info)) {}
    const DeviceInfo& info() const override { return info_; }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const>) override {
        return nullptr;
    }

private:
    DeviceInfo info_;
};

class SavedCostsTest : public testing::Test {
protected:
    SavedCostsTest() {
        fs::remove_all(folder_);
        learnt_.costs().restore(0, 0, {{1e-6, 2e-9}, 0.1, 7});
        learnt_.costs().restore(0, 1, {{3e-6, 4e-9}, 0.2, 8});
        learnt_.set_latency(0, 1, 5e-6);
        learnt_.set_latency(1, 0, 6e-6);
    }
    ~SavedCostsTest() override { fs::remove_all(folder_); }

    std::vector<Device*> devices() { return {&cpu_, &gpu_}; }
    std::vector<const TaskBody*> bodies() const { return {&body_}; }
    void save() { SavedCosts(file_).save(bodies(), devices(), true, learnt_); }
    bool restore(const std::vector<Device*>& devices, TimingModel& timing, bool strict = true) {
        return SavedCosts(file_).restore(bodies(), devices, strict, timing);
    }

    fs::path folder_ = fs::path(testing::TempDir()) / "weft_saved_costs";
    fs::path file_ = folder_ / "costs.json";
    DescribedDevice cpu_{{.name = "a CPU", .kind = "tbb", .driver = "", .units = 2}};
    DescribedDevice gpu_{{.name = "a GPU", .kind = "opencl", .driver = "1.0", .units = 16}};
    TaskBody body_{"predict", 0, {}};
    TimingModel learnt_{1, 2};
    TimingModel next_{1, 2};
};

TEST_F(SavedCostsTest, TheNextRunStartsFromThem) {
    save();
    EXPECT_TRUE(restore(devices(), next_));
    for (std::uint32_t d : {0U, 1U}) {
        EXPECT_EQ(next_.costs().fit(0, d).cost.fixed, learnt_.costs().fit(0, d).cost.fixed);
        EXPECT_EQ(next_.costs().fit(0, d).cost.per_item, learnt_.costs().fit(0, d).cost.per_item);
        EXPECT_EQ(next_.costs().fit(0, d).frames, learnt_.costs().fit(0, d).frames);
    }
    EXPECT_EQ(next_.latency(0, 1), 5e-6);
    EXPECT_EQ(next_.latency(1, 0), 6e-6);
}

TEST_F(SavedCostsTest, DevicesAreFoundUnderOtherNumbers) {
    save();
    EXPECT_TRUE(restore({&gpu_, &cpu_}, next_));
    EXPECT_EQ(next_.costs().fit(0, 0).cost.fixed, 3e-6);
    EXPECT_EQ(next_.latency(0, 1), 6e-6);
}

TEST_F(SavedCostsTest, AnotherDriverOrKernelOrArithmeticIsNotKnown) {
    save();
    DescribedDevice updated{{.name = "a GPU", .kind = "opencl", .driver = "1.1", .units = 16}};
    EXPECT_FALSE(restore({&cpu_, &updated}, next_));
    EXPECT_TRUE(next_.costs().known(0, 0));
    EXPECT_FALSE(next_.costs().known(0, 1));

    TimingModel fast(1, 2);
    EXPECT_FALSE(restore(devices(), fast, false));
    EXPECT_FALSE(fast.costs().known(0, 0));

    body_.name = "seams";
    TimingModel other(1, 2);
    EXPECT_FALSE(restore(devices(), other));
    EXPECT_FALSE(other.costs().known(0, 0));
}

TEST_F(SavedCostsTest, KeepsWhatOtherRunsHaveWritten) {
    SavedCosts early(file_);
    save();
    body_.name = "seams";
    early.save(bodies(), devices(), true, learnt_);
    EXPECT_TRUE(restore(devices(), next_));
    body_.name = "predict";
    EXPECT_TRUE(restore(devices(), next_));
}

TEST_F(SavedCostsTest, RunsThatEndTogetherLoseNothing) {
    constexpr int kRuns = 16;
    std::vector<TaskBody> bodies;
    for (int i = 0; i < kRuns; ++i) bodies.push_back({"kind " + std::to_string(i), 0, {}});
    {
        std::vector<JoiningThread> runs;
        for (const TaskBody& body : bodies) {
            runs.emplace_back([&] {
                const std::vector<const TaskBody*> own{&body};
                SavedCosts(file_).save(own, devices(), true, learnt_);
            });
        }
    }
    for (const TaskBody& body : bodies) {
        const std::vector<const TaskBody*> own{&body};
        EXPECT_TRUE(SavedCosts(file_).restore(own, devices(), true, next_)) << body.name;
    }
}

TEST_F(SavedCostsTest, AMissingOrDamagedFileIsAnEmptyOne) {
    EXPECT_FALSE(restore(devices(), next_));
    fs::create_directories(folder_);
    for (const char* text : {"", "{", "[]", R"({"format": 7})", R"({"format": "weft-costs 1"})",
                             R"({"format": "weft-costs 1", "fits": {"x": 3}, "latencies": {}})",
                             R"({"format": "weft-costs 9", "fits": {}, "latencies": {}})"}) {
        std::ofstream(file_, std::ios::trunc) << text;
        EXPECT_FALSE(restore(devices(), next_)) << text;
        EXPECT_FALSE(next_.costs().known(0, 0)) << text;
    }
    save();
    EXPECT_TRUE(restore(devices(), next_));
}

}  // namespace
}  // namespace weft::test
