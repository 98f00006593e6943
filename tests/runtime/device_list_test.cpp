#include "runtime/device_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "runtime/cores.h"
#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"

namespace weft::test {
namespace {

std::string error_of(const std::string& list) {
    try {
        open_devices(list);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

struct Bad {
    std::string list;
    std::string named;  ///< what the message has to say
};

TEST(DeviceList, EveryMistakeIsAnErrorThatNamesIt) {
    const Bad bad[] = {
        {"", "''"},
        {"+", "''"},
        {"cpu/1+", "''"},
        {"+cpu/1", "''"},
        {"gpu:0", "'gpu:0'"},
        {"gpu/0", "'gpu/0'"},
        {"CPU", "'CPU'"},
        {" cpu", "' cpu'"},
        {"cpu,opencl", "'cpu,opencl'"},
        {"cpu:0", "'cpu:0'"},
        {"cpu/", "'cpu/'"},
        {"cpu/0", "'cpu/0'"},
        {"cpu/-1", "'-1'"},
        {"cpu/x", "'x'"},
        {"cpu/1x", "'1x'"},
        {"cpu/1.5", "'1.5'"},
        {"cpu/1/2", "'1/2'"},
        {"cpu/99999999999", "'99999999999'"},
        {"cpu/1+gpus", "'gpus'"},
        {"hybrid/2", "'hybrid/2'"},
        {"hybrid:0", "'hybrid:0'"},
        {"opencl:", "'opencl:'"},
        {"opencl:-1", "'-1'"},
        {"opencl:nonesuch/1", "'opencl:nonesuch/1'"},
        {"opencl/1:0", "'1:0'"},
        {"opencl:0/", "'opencl:0/'"},
        {"opencl:0/0", "'opencl:0/0'"},
        {"opencl:0/x", "'x'"},
        {"opencl:99", "'opencl:99'"},
        {"opencl:0/1000", "1000"},
        {"cpu/1000", "1000 cores"},
        {"cpu/2147483647+cpu/2147483647", "4294967294 cores"},
        {"cpu/1+cpu/2147483647+cpu", "2147483649 cores"},
    };
    for (const Bad& b : bad) {
        const std::string message = error_of(b.list);
        EXPECT_NE(message.find(b.named), std::string::npos)
            << "'" << b.list << "' gave '" << message << "'";
        EXPECT_NE(message.find("--device"), std::string::npos) << message;
    }
}

TEST(DeviceList, DevicesNeverShareACore) {
    const std::size_t cores = usable_cores().size();
    std::string list = "cpu/1";
    for (std::size_t i = 1; i < cores; ++i) list += "+cpu/1";
    EXPECT_EQ(open_devices(list).size(), cores);
    EXPECT_NE(error_of(list + "+cpu/1").find("never share a core"), std::string::npos);
    EXPECT_NE(error_of(list + "+cpu").find("never share a core"), std::string::npos);
}

TEST(DeviceList, UnnumberedPartsShareWhatIsLeft) {
    const int cores = static_cast<int>(usable_cores().size());
    EXPECT_EQ(open_devices("cpu").front()->info().units, cores);
    EXPECT_EQ(open_devices("cpu/1").front()->info().units, 1);
    if (cores < 2) return;
    const auto devices = open_devices("cpu/1+cpu");
    EXPECT_EQ(devices[0]->info().units, 1);
    EXPECT_EQ(devices[1]->info().units, cores - 1);
}

TEST(DeviceList, KeepsItsOrder) {
    if (opencl_devices().empty() || usable_cores().size() < 2) GTEST_SKIP();
    const auto devices = open_devices("opencl:0/1+cpu/1");
    EXPECT_EQ(devices[0]->info().kind, "opencl");
    EXPECT_EQ(devices[1]->info().kind, "tbb");
}

TEST(DeviceList, TeamsShareTheCores) {
    const int cores = static_cast<int>(usable_cores().size());
    const auto devices = open_devices("cpu/1|cpu");
    ASSERT_EQ(devices.size(), 2U);
    EXPECT_EQ(devices[0]->info().team, 0);
    EXPECT_EQ(devices[0]->info().units, 1);
    EXPECT_EQ(devices[1]->info().team, 1);
    EXPECT_EQ(devices[1]->info().units, cores);
    EXPECT_NE(error_of("cpu|"), "");
    EXPECT_NE(error_of("cpu|cpu/9999"), "");
    EXPECT_NO_THROW(check_device_list("cpu/1+opencl:0/1|cpu"));
    EXPECT_THROW(check_device_list("cpu||cpu"), UserError);
}

/// TBB on all cores is among what `hybrid` may choose, so it is never slower.
TEST(DeviceList, HybridHasTheWholeCpuWhereOpenClIsTheCpu) {
    if (opencl_devices().empty() || usable_cores().size() < 2) GTEST_SKIP();
    if (!std::ranges::all_of(opencl_devices(), &OpenClDeviceSummary::is_cpu)) GTEST_SKIP();
    const auto devices = open_devices("hybrid");
    const auto is_whole = [](const auto& device) {
        return device->info().kind == "tbb" &&
               device->info().units == static_cast<int>(usable_cores().size());
    };
    EXPECT_EQ(std::ranges::count_if(devices, is_whole), 1);
}

TEST(DeviceList, EveryAvailableDeviceOpens) {
    for (const std::string& name : available_devices()) {
        EXPECT_EQ(open_devices(name).size(), 1U) << name;
    }
    EXPECT_FALSE(open_devices("hybrid").empty());
    EXPECT_EQ(open_devices(hybrid_devices()).size(), open_devices("hybrid").size());
}

TEST(DeviceList, OptionsOverruleWhatADeviceSaysOfItself) {
    EXPECT_EQ(open_devices("cpu/1").front()->info().lanes, kernels::widest_pack());
    DeviceOptions options;
    options.cpu_lanes = options.opencl_lanes = 1;
    options.memory = MemoryModel::kDiscrete;
    EXPECT_EQ(open_devices("cpu/1", options).front()->info().lanes, 1);
    if (opencl_devices().empty()) return;
    const auto devices = open_devices("opencl:0", options);
    EXPECT_EQ(devices.front()->info().memory, MemoryModel::kDiscrete);
    EXPECT_EQ(devices.front()->info().lanes, 1);
    EXPECT_TRUE(devices.front()->info().strict);
    options.strict_math = false;
    EXPECT_FALSE(open_devices("opencl:0", options).front()->info().strict);
}

TEST(DeviceList, OpenClDevicesHaveNamesAndKinds) {
    const auto devices = opencl_devices();
    if (devices.empty()) GTEST_SKIP() << "no OpenCL platform";
    const auto upper = [](std::string text) {
        for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return text;
    };
    const std::string platform = upper(devices.front().platform.substr(0, 6));
    EXPECT_EQ(open_devices("opencl:" + platform + "/1").front()->info().units, 1);
    const bool has_gpu = std::ranges::any_of(devices, &OpenClDeviceSummary::is_gpu);
    const std::string message = error_of("gpu");
    EXPECT_EQ(message.empty(), has_gpu);
    if (!has_gpu) {
        EXPECT_NE(message.find(devices.front().name), std::string::npos) << message;
    }
}

TEST(DeviceList, IsCheckedWithoutLookingForDevices) {
    for (const char* list : {"cpu", "gpu", "opencl:9", "opencl:nonesuch/2", "hybrid", "cpu/999"}) {
        EXPECT_NO_THROW(check_device_list(list)) << list;
    }
    for (const char* list : {"", "cpux", "cpu/0", "hybrid/2"}) {
        EXPECT_THROW(check_device_list(list), UserError) << list;
    }
}

TEST(DeviceList, SaysWhetherOpenClIsAskedFor) {
    for (const char* list : {"cpu", "cpu/2", "cpu/1|cpu"}) EXPECT_FALSE(touches_opencl(list));
    for (const char* list : {"gpu", "hybrid", "cpu+opencl:0/1", "cpu|opencl:nonesuch"}) {
        EXPECT_TRUE(touches_opencl(list)) << list;
    }
    EXPECT_THROW(touches_opencl("cpu+"), UserError);
}

}  // namespace
}  // namespace weft::test
