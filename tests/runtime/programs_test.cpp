// What is kept of built programs. Runs here take it from a driver that keeps its own (PoCL), so the
// folder that others need is tried by itself.

#include "runtime/opencl/programs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "runtime/opencl/platforms.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

class ProgramsTest : public testing::Test {
protected:
    ProgramsTest() {
        fs::remove_all(folder_);
        if (const char* value = std::getenv("WEFT_CACHE_DIR")) before_ = value;
        ::setenv("WEFT_CACHE_DIR", folder_.c_str(), 1);
    }
    ~ProgramsTest() override {
        fs::remove_all(folder_);
        if (before_)
            ::setenv("WEFT_CACHE_DIR", before_->c_str(), 1);
        else
            ::unsetenv("WEFT_CACHE_DIR");
    }

    void SetUp() override {
        for (const cl::Platform& platform : opencl_platforms()) {
            const auto devices = devices_of(platform);
            if (device_() == nullptr && !devices.empty()) device_ = devices.front();
        }
        if (device_() == nullptr) GTEST_SKIP() << "no OpenCL device here";
        context_ = cl::Context(device_);
    }

    /// As by a process of its own. A program that comes from a binary has no source.
    bool builds_from_source(bool keep_binaries) {
        const EntryPoints points{
            EntryStyle::kPerStrip, {"one"}, "__kernel void one(__global int* x) { x[0] = 1; }", {}};
        Programs programs(context_, device_, {1, /*strict=*/true, keep_binaries});
        return !programs.program(points).getInfo<CL_PROGRAM_SOURCE>().empty();
    }

    std::vector<fs::path> kept() const {
        std::vector<fs::path> files;
        if (!fs::exists(folder_)) return files;
        for (const auto& entry : fs::directory_iterator(folder_)) files.push_back(entry.path());
        return files;
    }

    fs::path folder_ = fs::path(testing::TempDir()) / "weft_programs";
    cl::Device device_;
    cl::Context context_;

private:
    std::optional<std::string> before_;
};

TEST_F(ProgramsTest, AreBuiltOnceWhereBinariesAreKept) {
    EXPECT_TRUE(builds_from_source(true));
    EXPECT_EQ(kept().size(), 1u);
    EXPECT_FALSE(builds_from_source(true));
    EXPECT_EQ(kept().size(), 1u);
}

TEST_F(ProgramsTest, AreBuiltAnewWhereABinaryIsDamaged) {
    builds_from_source(true);
    ASSERT_EQ(kept().size(), 1u);
    std::ofstream(kept().front()) << "none";
    EXPECT_TRUE(builds_from_source(true));
    EXPECT_FALSE(builds_from_source(true));
}

TEST_F(ProgramsTest, AreNotKeptWhereTheDriverKeepsItsOwn) {
    EXPECT_TRUE(builds_from_source(false));
    EXPECT_TRUE(kept().empty());
}

}  // namespace
}  // namespace weft::test
