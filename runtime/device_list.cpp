#include "runtime/device_list.h"

#include <algorithm>
#include <charconv>
#include <map>

#include "runtime/cores.h"
#include "runtime/error.h"
#include "runtime/opencl/opencl_device.h"
#include "runtime/opencl/probe.h"
#include "runtime/tbb/cpu_device.h"

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
    int index = -1;  ///< of an OpenCL device
    int units = 0;   ///< 0: all that are free
};

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw UserError("--device: '" + text + "': " + why +
                    "; a device is cpu, cpu/N, opencl, opencl:I, opencl:I/N or hybrid, "
                    "several are joined by '+'");
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
    Part part{text};
    std::string rest = text;
    if (const auto units = cut_off(rest, '/')) part.units = to_number(*units, text, 1);
    const auto index = cut_off(rest, ':');
    if (rest == "cpu" && !index) {
        part.is_cpu = true;
    } else if (rest == "opencl") {
        part.index = index ? to_number(*index, text, 0) : kBestDevice;
    } else {
        refuse(text, "unknown device");
    }
    return part;
}

std::vector<Part> parse(const std::string& list) {
    std::vector<Part> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = list.find('+', begin);
        const std::string text = list.substr(begin, end == std::string::npos ? end : end - begin);
        if (text == "hybrid") {
            for (Part& part : parse(hybrid_devices())) parts.push_back(std::move(part));
        } else {
            parts.push_back(parse_part(text));
        }
        if (end == std::string::npos) return parts;
        begin = end + 1;
    }
}

/// Where all OpenCL parts say how many units they want, a driver on the CPU needs no more threads.
void limit_driver(const std::vector<Part>& parts) {
    int units = 0;
    for (const Part& part : parts) {
        if (part.is_cpu) continue;
        if (part.units == 0) return;
        units += part.units;
    }
    if (units > 0) limit_cpu_driver(units);
}

/// Finds the devices that the parts mean.
void find_devices(std::vector<Part>& parts) {
    for (Part& part : parts) {
        if (part.is_cpu) continue;
        const auto devices = opencl_devices();
        if (devices.empty()) {
            refuse(part.text,
                   "no OpenCL platform was found (is a driver such as pocl-opencl-icd installed?)");
        }
        if (part.index == kBestDevice) part.index = best_of(devices);
        const int count = static_cast<int>(devices.size());
        if (part.index >= count) {
            refuse(part.text, "the last OpenCL device is opencl:" + std::to_string(count - 1) +
                                  "; see weft devices");
        }
        const int units = devices[static_cast<std::size_t>(part.index)].units;
        if (part.units > units) {
            refuse(part.text, "this device has " + std::to_string(units) + " compute units");
        }
    }
}

bool is_cpu_device(const Part& part) {
    return part.is_cpu || opencl_devices()[static_cast<std::size_t>(part.index)].is_cpu;
}

/// Gives parts without a number theirs, and checks that the cores suffice.
void share_cores(std::vector<Part>& parts, int cores) {
    int asked = 0;
    int open = 0;
    for (const Part& part : parts) {
        if (!is_cpu_device(part)) continue;
        asked += part.units;
        if (part.units == 0) ++open;
    }
    if (asked + open > cores) {
        throw UserError("--device: these devices ask for " + std::to_string(asked + open) +
                        " cores, and devices never share a core; this process may use " +
                        std::to_string(cores));
    }
    for (Part& part : parts) {
        if (part.units != 0 || !is_cpu_device(part)) continue;
        part.units = (cores - asked) / open;
        if (!part.is_cpu) {  // a driver may show fewer units than there are cores
            const auto index = static_cast<std::size_t>(part.index);
            part.units = std::min(part.units, opencl_devices()[index].units);
        }
        asked += part.units;
        --open;
    }
}

class Opener {
public:
    Opener(std::vector<Part> parts, const DeviceOptions& options)
        : parts_(std::move(parts)), options_(options), free_cores_(usable_cores()) {}

    std::vector<std::unique_ptr<Device>> open() {
        limit_driver(parts_);
        find_devices(parts_);
        share_cores(parts_, static_cast<int>(free_cores_.size()));
        open_opencl();
        std::vector<std::unique_ptr<Device>> devices;
        for (const Part& part : parts_) {
            devices.push_back(part.is_cpu ? open_cpu(part.units) : next_opencl(part.index));
        }
        return devices;
    }

private:
    /// All parts of one OpenCL device are divided off it at once. They take its first units, and
    /// those are the first cores: what is left for TBB are the last.
    void open_opencl() {
        std::map<int, std::vector<int>> units;
        for (const Part& part : parts_) {
            if (!part.is_cpu) units[part.index].push_back(part.units);
        }
        for (auto& [index, list] : units) {
            if (list == std::vector<int>{0}) list.clear();  // whole
            opened_[index] = open_opencl_device(index, list, options_);
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
            cores.assign(free_cores_.begin(), free_cores_.begin() + threads);
            free_cores_.erase(free_cores_.begin(), free_cores_.begin() + threads);
        }
        return make_cpu_device(threads, cores, options_.cpu_lanes == 1 ? 1 : 8);
    }

    std::unique_ptr<Device> next_opencl(int index) {
        auto& list = opened_[index];
        std::unique_ptr<Device> device = std::move(list.front());
        list.erase(list.begin());
        return device;
    }

    std::vector<Part> parts_;
    DeviceOptions options_;
    std::vector<int> free_cores_;
    std::map<int, std::vector<std::unique_ptr<Device>>> opened_;
    bool pins_ = false;  ///< some OpenCL device is the CPU itself
};

}  // namespace

std::vector<std::unique_ptr<Device>> open_devices(const std::string& list,
                                                  const DeviceOptions& options) {
    return Opener(parse(list), options).open();
}

std::vector<std::string> available_devices() {
    std::vector<std::string> list{"cpu"};
    for (std::size_t i = 0; i < opencl_devices().size(); ++i) {
        list.push_back("opencl:" + std::to_string(i));
    }
    return list;
}

std::string hybrid_devices() {
    const auto devices = probe_opencl_devices();
    const int cores = static_cast<int>(usable_cores().size());
    if (devices.empty()) return "cpu";
    const int best = best_of(devices);
    const std::string opencl = "opencl:" + std::to_string(best);
    if (!devices[static_cast<std::size_t>(best)].is_cpu) {
        // One core stays with the driver's threads, which feed the GPU.
        return "cpu/" + std::to_string(std::max(1, cores - 1)) + "+" + opencl;
    }
    if (cores < 2) return "cpu";
    return "cpu/" + std::to_string(cores - cores / 2) + "+" + opencl + "/" +
           std::to_string(cores / 2);
}

}  // namespace weft
