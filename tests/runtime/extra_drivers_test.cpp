#include "runtime/opencl/extra_drivers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace weft {
namespace {

namespace fs = std::filesystem;

class ExtraDriversTest : public testing::Test {
protected:
    void SetUp() override {
        ::unsetenv("OCL_ICD_VENDORS");
        ::unsetenv("OPENCL_VENDOR_PATH");
        fs::create_directories(places_.registrations);
        fs::create_directories(folder_ / "lib");
        places_.libraries = {folder_ / "none", folder_ / "lib"};
    }
    void TearDown() override {
        fs::remove_all(folder_);
        ::unsetenv("OCL_ICD_VENDORS");
    }

    std::string library(const std::string& name) {
        const fs::path file = folder_ / "lib" / name;
        std::ofstream(file) << "a driver";
        return file.string();
    }
    void register_driver(const std::string& file, const std::string& library) {
        std::ofstream(places_.registrations / file) << library << '\n';
    }

    const fs::path folder_ = fs::path(testing::TempDir()) / "weft_extra_drivers";
    DriverPlaces places_{.wanted = "", .registrations = folder_ / "vendors", .libraries = {}};
};

using Names = std::vector<std::string>;

TEST_F(ExtraDriversTest, AreThoseThatAreThereAndNotRegistered) {
    const std::string pocl = library("libpocl.so.2");
    places_.wanted = pocl + ":" + (folder_ / "libmissing.so").string();
    EXPECT_EQ(unregistered_drivers(places_), Names{pocl});
    const std::string nvidia = library("libnvidia-opencl.so.1");
    EXPECT_EQ(unregistered_drivers(places_), (Names{pocl, nvidia}));

    register_driver("nvidia.icd", "libnvidia-opencl.so.1");
    EXPECT_EQ(unregistered_drivers(places_), Names{pocl});
    register_driver("pocl.icd", "/usr/lib/libpocl.so.2.10.0");
    EXPECT_EQ(unregistered_drivers(places_), Names{});
}

TEST_F(ExtraDriversTest, StandBesideTheRegisteredOnesWhileTheLoaderStarts) {
    places_.wanted = library("libpocl.so.2");
    register_driver("some.icd", "libsome.so");
    fs::path vendors;
    {
        const ExtraDrivers drivers(places_);
        ASSERT_NE(std::getenv("OCL_ICD_VENDORS"), nullptr);
        vendors = std::getenv("OCL_ICD_VENDORS");
        Names libraries;
        for (const auto& entry : fs::directory_iterator(vendors)) {
            EXPECT_EQ(entry.path().extension(), ".icd");
            std::getline(std::ifstream(entry.path()), libraries.emplace_back());
        }
        std::ranges::sort(libraries);
        EXPECT_EQ(libraries, (Names{places_.wanted, "libsome.so"}));
    }
    EXPECT_EQ(std::getenv("OCL_ICD_VENDORS"), nullptr);
    EXPECT_FALSE(fs::exists(vendors));
}

TEST_F(ExtraDriversTest, LeaveTheUsersOwnChoiceAlone) {
    places_.wanted = library("libpocl.so.2");
    ::setenv("OCL_ICD_VENDORS", "/somewhere", 1);
    { const ExtraDrivers drivers(places_); }
    EXPECT_STREQ(std::getenv("OCL_ICD_VENDORS"), "/somewhere");
}

TEST_F(ExtraDriversTest, ChangeNothingWhereThereAreNone) {
    const ExtraDrivers drivers(places_);
    EXPECT_EQ(std::getenv("OCL_ICD_VENDORS"), nullptr);
}

}  // namespace
}  // namespace weft
