#include "runtime/device_list.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>

#include "runtime/cores.h"
#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/opencl/probe.h"
#include "runtime/split.h"
#include "runtime/tbb/cpu_device.h"
#include "scheduler/assert.h"

namespace weft {

std::string_view name_of(MemoryModel memory) {
    switch (memory) {
        case MemoryModel::kHost:
            return "host";
        case MemoryModel::kMapped:
            return "mapped";
        case MemoryModel::kDiscrete:
            return "discrete";
    }
    return "";
}

namespace {

/// One element of a device list.
struct Part {
    std::string text;
    bool is_cpu = false;
    int index = -1;         ///< of an OpenCL device
    bool is_gpu = false;    ///< instead of an index: the first GPU
    std::string name = {};  ///< instead of an index: a part of its name, or of its platform's
    int units = 0;          ///< 0: all that are free
};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw UserError("device list (--device): '" + text + "': " + why +
                    "; a device is cpu, gpu, opencl, opencl:I, opencl:NAME or hybrid, with /N at "
                    "its end limited to N units (but hybrid); several are joined by '+', and '|' "
                    "stands between those that take turns");
}

int to_number(const std::string& digits, const std::string& text, int least) {
    int value = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc{} || stop != end || value < least) {
        refuse(text, "'" + digits + "' is not a number of at least " + std::to_string(least));
    }
    return value;
}

/// What begins with a digit or a sign is meant as a number; names do not.
bool is_number(const std::string& text) {
    return text.empty() || text.find_first_of("0123456789+-") == 0;
}

/// Splits off what stands behind `mark`.
std::optional<std::string> cut_off(std::string& text, char mark) {
    const std::size_t at = text.find(mark);
    if (at == std::string::npos) return std::nullopt;
    std::string rest = text.substr(at + 1);
    text.resize(at);
    return rest;
}

/// The first GPU, or else the first device. At least one is there.
int best_of(const std::vector<OpenClDeviceSummary>& devices) {
    const auto gpu = std::find_if(devices.begin(), devices.end(),
                                  [](const OpenClDeviceSummary& d) { return d.is_gpu; });
    return gpu == devices.end() ? 0 : static_cast<int>(gpu - devices.begin());
}

constexpr int kBestDevice = -1;

/// Only what the text itself says: no device is looked for.
Part parse_part(const std::string& text) {
    Part part;
    part.text = text;
    std::string rest = text;
    if (const auto units = cut_off(rest, '/')) part.units = to_number(*units, text, 1);
    const auto index = cut_off(rest, ':');
    if (rest == "cpu" && !index) {
        part.is_cpu = true;
    } else if (rest == "gpu" && !index) {
        part.is_gpu = true;
    } else if (rest == "opencl" && index && !is_number(*index)) {
        part.name = *index;
    } else if (rest == "opencl") {
        part.index = index ? to_number(*index, text, 0) : kBestDevice;
    } else {
        refuse(text, "unknown device");
    }
    return part;
}

using Team = std::vector<Part>;

Team parse_team(const std::string& list) {
    Team parts;
    for (const std::string& text : split(list, '+')) {
        if (text == "hybrid") {
            const auto mixture = split(hybrid_devices(), '|').front();
            for (Part& part : parse_team(mixture)) parts.push_back(std::move(part));
        } else {
            parts.push_back(parse_part(text));
        }
    }
    return parts;
}

std::vector<Team> parse(const std::string& list) {
    std::vector<Team> teams;
    for (const std::string& text : split(list == "hybrid" ? hybrid_devices() : list, '|')) {
        teams.push_back(parse_team(text));
    }
    return teams;
}

/// As they are written, of all teams.
std::vector<std::string> elements_of(const std::string& list) {
    std::vector<std::string> elements;
    for (const std::string& team : split(list, '|')) {
        for (const std::string& text : split(team, '+')) elements.push_back(text);
    }
    return elements;
}

/// How many of the cores OpenCL may take at most, as the list says it: no driver is asked yet.
int most_opencl_units(const Team& parts, int cores) {
    long long opencl = 0;  // what is asked for may be any number, and so may the sum
    long long cpu = 0;
    bool all_numbered = true;
    for (const Part& part : parts) {
        (part.is_cpu ? cpu : opencl) += part.is_cpu ? std::max(part.units, 1) : part.units;
        all_numbered = all_numbered && (part.is_cpu || part.units > 0);
    }
    return static_cast<int>(std::clamp<long long>(all_numbered ? opencl : cores - cpu, 1, cores));
}

bool is_all_tbb(const Team& parts) {
    return std::ranges::all_of(parts, [](const Part& part) { return part.is_cpu; });
}

/// Drivers make their threads once, for the team that needs most.
int most_opencl_units(const std::vector<Team>& teams, int cores) {
    int most = 1;
    for (const Team& team : teams) {
        if (!is_all_tbb(team)) most = std::max(most, most_opencl_units(team, cores));
    }
    return most;
}

bool contains_word(std::string text, std::string word) {
    const auto lower = [](std::string& t) {
        std::ranges::transform(t, t.begin(), [](unsigned char c) { return std::tolower(c); });
    };
    lower(text);
    lower(word);
    return text.find(word) != std::string::npos;
}

/// By its name or its kind: numbers shift when a job's engine hides devices.
int find_described(const Part& part, const std::vector<OpenClDeviceSummary>& devices) {
    const auto fits = [&](const OpenClDeviceSummary& device) {
        if (part.is_gpu) return device.is_gpu;
        return contains_word(device.name, part.name) || contains_word(device.platform, part.name);
    };
    const auto found = std::ranges::find_if(devices, fits);
    if (found != devices.end()) return static_cast<int>(found - devices.begin());
    std::string there;
    for (const auto& device : devices) there += (there.empty() ? "" : ", ") + device.name;
    refuse(part.text,
           (part.is_gpu ? "no OpenCL device is a GPU" : "no OpenCL device is called so") +
               std::string("; there is ") + there);
}

std::string what_may_help() {
    const auto troubles = opencl_troubles();
    return troubles.empty() ? "(is a driver such as pocl-opencl-icd installed?)"
                            : "(" + troubles.front() + ")";
}

/// Finds the devices that the parts mean.
void find_devices(std::vector<Part>& parts) {
    for (Part& part : parts) {
        if (part.is_cpu) continue;
        const auto devices = opencl_devices();
        if (devices.empty()) {
            refuse(part.text, "no OpenCL platform was found " + what_may_help());
        }
        if (part.is_gpu || !part.name.empty())
            part.index = find_described(part, devices);
        else if (part.index == kBestDevice)
            part.index = best_of(devices);
        const int count = static_cast<int>(devices.size());
        if (part.index >= count) {
            refuse(part.text, "the last OpenCL device is opencl:" + std::to_string(count - 1) +
                                  "; see weft devices");
        }
        const int units = devices[static_cast<std::size_t>(part.index)].units;
        if (part.units > units) {
            refuse(part.text, "this device has " + std::to_string(units) +
                                  (units == 1 ? " compute unit" : " compute units") +
                                  " that this process may use");
        }
    }
}

bool is_cpu_device(const Part& part) {
    return part.is_cpu || opencl_devices()[static_cast<std::size_t>(part.index)].is_cpu;
}

/// Gives parts without a number theirs, and checks that the cores suffice.
void share_cores(std::vector<Part>& parts, int cores) {
    long long asked = 0;
    long long open = 0;
    for (const Part& part : parts) {
        if (!is_cpu_device(part)) continue;
        asked += part.units;
        if (part.units == 0) ++open;
    }
    if (asked + open > cores) {
        throw UserError("device list (--device): these devices ask for " +
                        std::to_string(asked + open) +
                        " cores, and devices never share a core; this process may use " +
                        std::to_string(cores));
    }
    for (Part& part : parts) {
        if (part.units != 0 || !is_cpu_device(part)) continue;
        part.units = static_cast<int>((cores - asked) / open);
        if (!part.is_cpu) {  // a driver may show fewer units than there are cores
            const auto index = static_cast<std::size_t>(part.index);
            part.units = std::min(part.units, opencl_devices()[index].units);
        }
        asked += part.units;
        --open;
    }
}

/// Opens the devices of one team.
class Opener {
public:
    Opener(Team parts, int number, std::vector<int> cores, const DeviceOptions& options)
        : parts_(std::move(parts)),
          number_(number),
          options_(options),
          free_cores_(std::move(cores)) {}

    void open_into(std::vector<std::unique_ptr<Device>>& devices) {
        const int cores = static_cast<int>(free_cores_.size());
        if (!is_all_tbb(parts_)) find_devices(parts_);
        share_cores(parts_, cores);
        open_opencl();
        for (const Part& part : parts_) {
            devices.push_back(part.is_cpu ? open_cpu(part.units) : next_opencl(part.index));
        }
    }

private:
    /// All parts of one OpenCL device are divided off it at once, from its first unit on.
    void open_opencl() {
        std::map<int, std::vector<int>> units;
        for (const Part& part : parts_) {
            if (!part.is_cpu) units[part.index].push_back(part.units);
        }
        for (auto& [index, list] : units) {
            if (list == std::vector<int>{0}) list.clear();  // whole
            opened_[index] = open_opencl_device(index, list, options_, number_);
            if (!opencl_devices()[static_cast<std::size_t>(index)].is_cpu) continue;
            for (const auto& device : opened_[index]) {
                const auto taken = std::min<std::size_t>(
                    static_cast<std::size_t>(device->info().units), free_cores_.size());
                free_cores_.erase(free_cores_.begin(),
                                  free_cores_.begin() + static_cast<std::ptrdiff_t>(taken));
            }
            pins_ = true;
        }
    }

    std::unique_ptr<Device> open_cpu(int threads) {
        std::vector<int> cores;
        if (pins_) {
            WEFT_ASSERT(static_cast<std::size_t>(threads) <= free_cores_.size());
            cores.assign(free_cores_.begin(), free_cores_.begin() + threads);
            free_cores_.erase(free_cores_.begin(), free_cores_.begin() + threads);
        }
        return make_cpu_device(threads, cores, options_.cpu_lanes, number_);
    }

    std::unique_ptr<Device> next_opencl(int index) {
        auto& list = opened_[index];
        WEFT_ASSERT(!list.empty());
        std::unique_ptr<Device> device = std::move(list.front());
        list.erase(list.begin());
        return device;
    }

    Team parts_;
    int number_;
    DeviceOptions options_;
    std::vector<int> free_cores_;
    std::map<int, std::vector<std::unique_ptr<Device>>> opened_;
    bool pins_ = false;  ///< some OpenCL device is the CPU itself
};

/// Planners keep sets of devices in one word.
void refuse_too_many(std::size_t count, const std::string& list) {
    constexpr std::size_t kMost = 32;
    if (count <= kMost) return;
    throw UserError("device list (--device): '" + list + "': " + std::to_string(count) +
                    " devices, and the most are " + std::to_string(kMost));
}

}  // namespace

/// OpenCL has the first cores, and TBB what is left. Drivers on the CPU make their threads when
/// they are found (PoCL 3.1) or when a context is made: these inherit the cores of the thread that
/// asks. (POCL_AFFINITY would bind thread i to the machine's core i, whatever this process may
/// use.)
std::vector<std::unique_ptr<Device>> open_devices(const std::string& list,
                                                  const DeviceOptions& options) {
    const std::vector<Team> teams = parse(list);
    std::vector<std::unique_ptr<Device>> devices;
    std::vector<int> opencl_cores;
    if (!std::ranges::all_of(teams, is_all_tbb)) {
        opencl_cores = usable_cores();
        const auto cores = static_cast<int>(opencl_cores.size());
        const int units = most_opencl_units(teams, cores);
        limit_cpu_driver(units);
        opencl_cores.resize(static_cast<std::size_t>(units));
    }
    const std::vector<int> all_cores = usable_cores();
    const PinnedThread here(opencl_cores);
    for (const Team& team : teams) {
        Opener(team, static_cast<int>(&team - teams.data()), all_cores, options).open_into(devices);
    }
    refuse_too_many(devices.size(), list);
    return devices;
}

void check_device_list(const std::string& list) {
    for (const std::string& text : elements_of(list)) {
        if (text != "hybrid") parse_part(text);
    }
}

bool touches_opencl(const std::string& list) {
    return std::ranges::any_of(elements_of(list), [](const std::string& text) {
        return text == "hybrid" || !parse_part(text).is_cpu;
    });
}

std::vector<std::string> available_devices() {
    std::vector<std::string> list{"cpu"};
    for (std::size_t i = 0; i < opencl_devices().size(); ++i) {
        list.push_back("opencl:" + std::to_string(i));
    }
    return list;
}

std::string hybrid_devices() {
    const auto& devices = probe_opencl().devices;
    const int cores = static_cast<int>(usable_cores().size());
    if (devices.empty()) return "cpu";
    const int best = best_of(devices);
    const std::string opencl = "opencl:" + std::to_string(best);
    if (!devices[static_cast<std::size_t>(best)].is_cpu) {
        // One core stays with the driver's threads, which feed the GPU.
        return "cpu/" + std::to_string(std::max(1, cores - 1)) + "+" + opencl;
    }
    if (cores < 2) return "cpu";
    // The cores are the same, so TBB on all of them may be faster: it takes turns with the mixture.
    return "cpu/" + std::to_string(cores - cores / 2) + "+" + opencl + "/" +
           std::to_string(cores / 2) + "|cpu";
}

}  // namespace weft
