#include "runtime/trace/host_info.h"

#include <hdf5.h>
#include <sys/utsname.h>
#include <tbb/version.h>
#include <unistd.h>

#include <fstream>

#include "runtime/cores.h"
#include "runtime/io/hdf5/handle.h"

#ifdef __APPLE__
#include <sys/sysctl.h>
#endif

namespace weft {

namespace {

#ifdef __APPLE__
std::string cpu_model() {
    char name[256] = "";
    std::size_t size = sizeof name;
    return ::sysctlbyname("machdep.cpu.brand_string", name, &size, nullptr, 0) == 0 ? name : "";
}
#else
std::string cpu_model() {
    std::ifstream list("/proc/cpuinfo");
    for (std::string line; std::getline(list, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return "";
}
#endif

/// As the system calls itself, e.g. "Debian GNU/Linux 12 (bookworm)".
std::string distribution() {
    const std::string key = "PRETTY_NAME=\"";
    std::ifstream list("/etc/os-release");
    for (std::string line; std::getline(list, line);) {
        if (line.starts_with(key)) return line.substr(key.size(), line.size() - key.size() - 1);
    }
    return "";
}

std::string memory_bytes() {
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long size = ::sysconf(_SC_PAGESIZE);
    if (pages <= 0 || size <= 0) return "";
    return std::to_string(static_cast<unsigned long long>(pages) *
                          static_cast<unsigned long long>(size));
}

void add(TextPairs& pairs, const char* key, const std::string& value) {
    if (!value.empty()) pairs.emplace_back(key, value);
}

}  // namespace

TextPairs host_info() {
    utsname system{};
    ::uname(&system);
    TextPairs pairs;
    add(pairs, "name", system.nodename);
    add(pairs, "cpu", cpu_model());
    add(pairs, "cores", std::to_string(usable_cores().size()));
    add(pairs, "memory_bytes", memory_bytes());
    add(pairs, "os", distribution());
    add(pairs, "kernel",
        std::string(system.sysname) + ' ' + system.release + ' ' + std::string(system.machine));
    return pairs;
}

TextPairs runtime_versions() {
    unsigned major = 0;
    unsigned minor = 0;
    unsigned release = 0;
    const hdf5::Session session;  // the first call of the library sets how it ends
    H5get_libversion(&major, &minor, &release);
#ifdef __clang__
    const std::string compiler = __VERSION__;
#else
    const std::string compiler = std::string("g++ ") + __VERSION__;
#endif
    return {{"compiler", compiler},
            {"tbb", TBB_runtime_version()},
            {"hdf5",
             std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(release)}};
}

}  // namespace weft
