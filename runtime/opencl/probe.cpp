#include "runtime/opencl/probe.h"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>

#include "runtime/io/process.h"
#include "runtime/io/system_call.h"
#include "runtime/split.h"

namespace weft {

namespace {

constexpr int kPatience = 60'000;  ///< for a driver that says nothing [ms]
std::atomic<bool> is_probed = false;

// ---- in the process that may end ----

void say(int to, const std::string& line) {
    if (!write_all(to, line)) ::_exit(1);
}

/// The number counts where there is no name.
bool is_among(const std::vector<OpenClPlatform>& unusable, const OpenClPlatform& platform) {
    return std::ranges::any_of(unusable, [&](const OpenClPlatform& u) {
        return u.name == platform.name && (!u.name.empty() || u.number == platform.number);
    });
}

/// What opening a device asks of it. Errors are no matter here: they can be told when it is opened.
void try_to_open(const cl::Device& device) {
    try {
        const cl::Context context(device);
        const cl::CommandQueue queue(context, device, CL_QUEUE_PROFILING_ENABLE);
    } catch (const cl::Error&) {
    }
}

void examine(int to, const cl::Device& device) {
    const auto summary = summarise(device);
    try_to_open(device);
    std::ostringstream line;
    line << "device\t" << summary.units << '\t' << summary.is_cpu << '\t' << summary.is_gpu << '\t'
         << summary.name << '\t' << summary.platform << '\n';
    say(to, line.str());
}

/// Announces each platform before it touches it: so the parent knows who was the last.
void examine_all(int to, const std::vector<OpenClPlatform>& unusable) {
    const auto platforms = opencl_platforms();
    for (int p = 0; p < static_cast<int>(platforms.size()); ++p) {
        const cl::Platform& platform = platforms[static_cast<std::size_t>(p)];
        if (is_among(unusable, {p, ""})) continue;
        say(to, "platform\t" + std::to_string(p) + '\n');
        const std::string name = name_of(platform);
        say(to, "name\t" + name + '\n');
        if (is_among(unusable, {-1, name})) continue;
        for (const cl::Device& device : devices_of(platform)) examine(to, device);
    }
    say(to, "end\n");
}

int exit_code_of_examination(int to, const std::vector<OpenClPlatform>& unusable) {
    try {
        examine_all(to, unusable);
        return 0;
    } catch (const std::exception&) {
        return 1;
    }
}

// ---- in this one ----

/// All that the child says until it ends; a child that is silent for too long is ended.
std::string listen(int from, pid_t child) {
    std::string text;
    pollfd ready{from, POLLIN, 0};
    while (until_uninterrupted([&] { return ::poll(&ready, 1, kPatience); }) > 0) {
        const std::string part = read_some(from);
        if (part.empty()) return text;
        text += part;
    }
    ::kill(child, SIGKILL);
    return text;
}

/// What one child said; nothing where none could be started.
std::optional<std::string> ask_child(const std::vector<OpenClPlatform>& unusable, int& status) {
    Pipe pipe;
    if (!pipe.is_open()) return std::nullopt;
    const pid_t child =
        start_process([&] { return exit_code_of_examination(pipe.writer(), unusable); });
    if (child < 0) return std::nullopt;
    pipe.close_writer();
    std::string text = listen(pipe.reader(), child);
    pipe.close_reader();
    status = wait_for_process(child);
    return text;
}

std::string end_of(int status) {
    if (!WIFSIGNALED(status)) return "gave up";
    if (WTERMSIG(status) == SIGKILL) return "did not answer";
    return std::string("was ended by it (") + ::strsignal(WTERMSIG(status)) + ")";
}

/// The platform that the child was at when it ended.
struct Last {
    OpenClPlatform platform;
    bool is_complete = false;
};

Last read(const std::string& text, std::vector<OpenClDeviceSummary>& devices) {
    Last last;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        auto words = split(line, '\t');
        words.resize(6);  // also of what was cut off
        if (words[0] == "platform") last.platform = {std::atoi(words[1].c_str()), ""};
        if (words[0] == "name") last.platform.name = words[1];
        if (words[0] == "end") last.is_complete = true;
        if (words[0] != "device") continue;
        devices.push_back(
            {words[4], words[5], std::atoi(words[1].c_str()), words[2] == "1", words[3] == "1"});
    }
    return last;
}

std::string words_for(const OpenClPlatform& platform) {
    if (platform.number < 0) return "all OpenCL drivers are";
    if (platform.name.empty()) {
        return "OpenCL platform " + std::to_string(platform.number) + " is";
    }
    return "the OpenCL platform '" + platform.name + "' is";
}

/// The loader (ocl-icd) asks all drivers for their devices, to sort platforms by them, before
/// anybody knows whom it asked. Without that, platforms come as they are registered.
bool leave_platforms_unsorted() {
    constexpr const char* kSort = "OCL_ICD_PLATFORM_SORT";
    const char* set = std::getenv(kSort);
    if (set != nullptr && std::strcmp(set, "none") == 0) return false;
    return ::setenv(kSort, "none", /*overwrite=*/1) == 0;
}

/// Notes who has ended the child. False: nobody can be named.
bool leave_out(const Last& last, int status, OpenClProbe& found) {
    found.no_loader = last.platform.number < 0;
    if (found.no_loader && leave_platforms_unsorted()) return true;
    found.troubles.push_back(words_for(last.platform) + " left out: the process that probed it " +
                             end_of(status));
    found.unusable.push_back(last.platform);
    return !found.no_loader;
}

/// Asks until nobody ends the child any more.
OpenClProbe probe() {
    constexpr std::size_t kMostUnusable = 16;
    OpenClProbe found;
    while (found.unusable.size() < kMostUnusable) {
        int status = 0;
        const auto text = ask_child(found.unusable, status);
        if (!text) return found;
        found.devices.clear();
        const Last last = read(*text, found.devices);
        found.no_loader = false;
        if (last.is_complete || !leave_out(last, status, found)) return found;
    }
    found.no_loader = true;
    return found;
}

}  // namespace

std::vector<cl::Platform> usable_platforms(const std::vector<OpenClPlatform>& unusable) {
    std::vector<cl::Platform> usable;
    const auto platforms = opencl_platforms();
    for (int p = 0; p < static_cast<int>(platforms.size()); ++p) {
        const cl::Platform& platform = platforms[static_cast<std::size_t>(p)];
        if (is_among(unusable, {p, ""}) || is_among(unusable, {-1, name_of(platform)})) continue;
        usable.push_back(platform);
    }
    return usable;
}

const OpenClProbe& probe_opencl() {
#ifdef __SANITIZE_THREAD__
    static const OpenClProbe found;  // its processes must not fork beside threads
#else
    static const OpenClProbe found = probe();
#endif
    is_probed = true;
    return found;
}

std::vector<std::string> opencl_troubles() {
    if (!is_probed) return {};
    return probe_opencl().troubles;
}

void limit_cpu_driver(int units) {
    ::setenv("POCL_MAX_PTHREAD_COUNT", std::to_string(units).c_str(), /*overwrite=*/0);
}

}  // namespace weft
