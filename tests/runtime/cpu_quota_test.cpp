#include "runtime/cpu_quota.h"

#include <gtest/gtest.h>

#include <fstream>

namespace weft {
namespace {

namespace fs = std::filesystem;

/// A machine's files, as a container sees them.
class CpuQuota : public ::testing::Test {
protected:
    void SetUp() override { fs::remove_all(root_); }
    void TearDown() override { fs::remove_all(root_); }

    void write(const fs::path& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }

    fs::path root_ = fs::temp_directory_path() /
                     (std::string("weft_quota_") +
                      ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CpuQuota, IsNoneWithoutGroupsOrLimits) {
    EXPECT_FALSE(cpu_quota(root_).has_value());
    write("proc/self/cgroup", "0::/a\n");
    EXPECT_FALSE(cpu_quota(root_).has_value());
    write("sys/fs/cgroup/a/cpu.max", "max 100000\n");
    EXPECT_FALSE(cpu_quota(root_).has_value());
}

TEST_F(CpuQuota, IsTheLeastOfAllGroupsAround) {
    write("proc/self/cgroup", "0::/a/b\n");
    write("sys/fs/cgroup/a/b/cpu.max", "400000 100000\n");
    EXPECT_EQ(cpu_quota(root_), 4.0);
    write("sys/fs/cgroup/a/cpu.max", "150000 100000\n");
    EXPECT_EQ(cpu_quota(root_), 1.5);
}

TEST_F(CpuQuota, OfAContainerThatSeesOnlyItsOwnGroup) {
    write("proc/self/cgroup", "0::/kubepods/pod7\n");
    write("sys/fs/cgroup/cpu.max", "200000 100000\n");
    EXPECT_EQ(cpu_quota(root_), 2.0);
}

TEST_F(CpuQuota, OfVersionOne) {
    write("proc/self/cgroup", "4:memory:/a\n3:cpu,cpuacct:/a\n2:cpuset:/a\n");
    write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "-1\n");
    write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
    EXPECT_FALSE(cpu_quota(root_).has_value());
    write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "300000\n");
    EXPECT_EQ(cpu_quota(root_), 3.0);
}

}  // namespace
}  // namespace weft
