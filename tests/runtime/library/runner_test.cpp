// What a runner tells of itself, apart from what it computes.

#include "weft/runner.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/planning/planned_executor.h"
#include "tests/runtime/library/own_device.h"
#include "tests/runtime/library/own_work.h"

namespace weft::test {
namespace {

/// Of a memory of its own, as it says. Never run.
class FarDevice final : public Device {
public:
    FarDevice() {
        info_.name = "far";
        info_.kind = "test";
        info_.memory = MemoryModel::kDiscrete;
    }
    const DeviceInfo& info() const override { return info_; }
    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) override {
        return near_.open_stream(bodies);
    }

private:
    DeviceInfo info_;
    OwnDevice near_;
};

template <class... Kinds>
std::vector<std::unique_ptr<Device>> devices() {
    std::vector<std::unique_ptr<Device>> list;
    (list.push_back(std::make_unique<Kinds>()), ...);
    return list;
}

TEST(Runner, SaysWhetherItsDevicesHandDataToEachOther) {
    OwnWork own;
    const auto has_transfers = [&](std::vector<std::unique_ptr<Device>> list) {
        return Runner(own.work, std::move(list), {.calibrate = 0}).describe().has_transfers;
    };
    EXPECT_FALSE((has_transfers(devices<OwnDevice>())));
    EXPECT_FALSE((has_transfers(devices<OwnDevice, OwnDevice>())));
    EXPECT_FALSE((has_transfers(devices<FarDevice>()))) << "there is nobody else";
    EXPECT_TRUE((has_transfers(devices<OwnDevice, FarDevice>())));
}

TEST(PlannedExecutor, HasNoCostsFromEarlierRunsWithoutAFileOfThem) {
    OwnWork own;
    PlannedExecutor nowhere(own.work, OwnWork::kStrips, devices<OwnDevice>(), {});
    EXPECT_FALSE(nowhere.restore_costs());
    const auto file = std::filesystem::path(testing::TempDir()) / "weft_no_such_costs.json";
    std::filesystem::remove(file);
    PlannedExecutor first_run(own.work, OwnWork::kStrips, devices<OwnDevice>(),
                              {.plan = PlanKind::kAuto, .division = {}, .cost_file = file});
    EXPECT_FALSE(first_run.restore_costs());
}

}  // namespace
}  // namespace weft::test
