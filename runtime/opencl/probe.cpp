#include "runtime/opencl/probe.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace weft {

namespace {

/// One device per line: units, is_cpu, is_gpu.
std::string list_devices() {
    std::ostringstream out;
    for (const OpenClDeviceSummary& d : opencl_devices()) {
        out << d.units << ' ' << d.is_cpu << ' ' << d.is_gpu << '\n';
    }
    return out.str();
}

std::vector<OpenClDeviceSummary> parse_list(const std::string& text) {
    std::vector<OpenClDeviceSummary> devices;
    std::istringstream in(text);
    OpenClDeviceSummary d;
    while (in >> d.units >> d.is_cpu >> d.is_gpu) devices.push_back(d);
    return devices;
}

std::string read_all(int descriptor) {
    std::string text;
    char part[512];
    ssize_t count = 0;
    while ((count = ::read(descriptor, part, sizeof part)) > 0) {
        text.append(part, static_cast<std::size_t>(count));
    }
    return text;
}

}  // namespace

std::vector<OpenClDeviceSummary> probe_opencl_devices() {
    int ends[2];
    if (::pipe(ends) != 0) return opencl_devices();
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) {
        ::close(ends[0]);
        ::close(ends[1]);
        return opencl_devices();
    }
    if (child == 0) {
        const std::string text = list_devices();
        const ssize_t written = ::write(ends[1], text.data(), text.size());
        ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
    }
    ::close(ends[1]);
    const std::string text = read_all(ends[0]);
    ::close(ends[0]);
    ::waitpid(child, nullptr, 0);
    return parse_list(text);
}

void limit_cpu_driver(int units) {
    ::setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(units).c_str(), /*overwrite=*/0);
}

}  // namespace weft
