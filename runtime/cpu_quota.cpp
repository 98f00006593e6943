#include "runtime/cpu_quota.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace weft {

namespace {

namespace fs = std::filesystem;

/// cgroup v2: "max 100000" or "150000 100000": microseconds of time in a period.
std::optional<double> quota_of_v2(const fs::path& group) {
    std::ifstream file(group / "cpu.max");
    double time = 0.0, period = 0.0;
    if (file >> time >> period && time > 0.0 && period > 0.0) return time / period;
    return std::nullopt;
}

/// cgroup v1: a file each; -1 without a limit.
std::optional<double> quota_of_v1(const fs::path& group) {
    std::ifstream time_file(group / "cpu.cfs_quota_us"), period_file(group / "cpu.cfs_period_us");
    double time = 0.0, period = 0.0;
    if (time_file >> time && period_file >> period && time > 0.0 && period > 0.0) {
        return time / period;
    }
    return std::nullopt;
}

using QuotaOf = std::optional<double> (*)(const fs::path& group);

/// The least of a group and of all that it is in. Inside a container the path may be that of the
/// host, and the folder not there: then the mount itself is the group.
std::optional<double> least_quota(const fs::path& mount, fs::path group, QuotaOf quota_of) {
    std::optional<double> least = quota_of(mount);
    for (group = group.relative_path(); !group.empty(); group = group.parent_path()) {
        const std::optional<double> quota = quota_of(mount / group);
        if (quota) least = std::min(least.value_or(*quota), *quota);
    }
    return least;
}

/// One of the comma-separated controllers of a group of v1.
bool has_cpu(const std::string& controllers) {
    return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

}  // namespace

std::optional<double> cpu_quota(const fs::path& root) {
    const fs::path mounts = root / "sys/fs/cgroup";
    std::ifstream groups(root / "proc/self/cgroup");
    std::optional<double> least;
    // Lines are "number:controllers:path"; v2 has number 0 and no controllers.
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == line.npos || second == line.npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path group = line.substr(second + 1);
        std::optional<double> quota;
        if (controllers.empty())
            quota = least_quota(mounts, group, quota_of_v2);
        else if (has_cpu(controllers))
            quota = least_quota(mounts / "cpu", group, quota_of_v1);
        if (quota) least = std::min(least.value_or(*quota), *quota);
    }
    return least;
}

}  // namespace weft
