#include "runtime/opencl/opencl_device.h"

#include <algorithm>
#include <numeric>

#include "runtime/opencl/extra_drivers.h"
#include "runtime/opencl/platforms.h"
#include "runtime/opencl/probe.h"
#include "runtime/opencl/stream.h"

namespace weft {

namespace {

std::vector<cl::Device> find_devices() {
    const OpenClProbe& probe = probe_opencl();
    if (probe.no_loader) return {};
    std::vector<cl::Device> devices;
    for (const cl::Platform& platform : usable_platforms(probe.unusable)) {
        const auto found = devices_of(platform);
        devices.insert(devices.end(), found.begin(), found.end());
    }
    return devices;
}

const std::vector<cl::Device>& all_devices() {
    static const std::vector<cl::Device> devices = find_devices();
    return devices;
}

bool is_type(const cl::Device& device, cl_device_type type) {
    return (device.getInfo<CL_DEVICE_TYPE>() & type) != 0;
}

std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
}

MemoryModel memory_model(const cl::Device& device) {
    // Interpreters such as oclgrind are CPU devices, but work on copies.
    if (device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() != CL_TRUE) return MemoryModel::kDiscrete;
    return is_type(device, CL_DEVICE_TYPE_CPU) ? MemoryModel::kHost : MemoryModel::kMapped;
}

/// CPU devices need no flag for correct rounding: their instructions round correctly.
bool rounds_correctly(const cl::Device& device) {
    return is_type(device, CL_DEVICE_TYPE_CPU) || (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() &
                                                   CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
}

bool is_pocl(const cl::Device& device) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    return name_of(platform) == "Portable Computing Language";
}

/// Large groups even where colours have few items: on an NVIDIA H200, groups of 1024 were 1.1
/// to 2.8 times as fast as groups of 256 (docs/measurements.md).
EntryOptions entry_options(const cl::Device& device, const DeviceOptions& options) {
    constexpr std::size_t kLargestGroup = 1024;
    const bool is_cpu = is_type(device, CL_DEVICE_TYPE_CPU);
    EntryOptions entries;
    entries.style =
        options.entry_style.value_or(is_cpu ? EntryStyle::kPerStrip : EntryStyle::kPerGroup);
    const auto largest = std::min(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>(), kLargestGroup);
    entries.group_size = options.group_size != 0 ? options.group_size : static_cast<int>(largest);
    entries.most_parameters = device.getInfo<CL_DEVICE_MAX_PARAMETER_SIZE>();
    return entries;
}

OpenClTarget describe(const cl::Device& device, const DeviceOptions& options) {
    OpenClTarget target;
    target.device = device;
    target.context = cl::Context(device);
    target.is_pocl = is_pocl(device);
    const bool is_cpu = is_type(device, CL_DEVICE_TYPE_CPU);
    target.entries = entry_options(device, options);

    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    DeviceInfo& info = target.info;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.kind = "opencl";
    info.driver = trimmed(platform.getInfo<CL_PLATFORM_NAME>()) + " " +
                  trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.memory = options.memory.value_or(memory_model(device));
    info.strict = options.strict_math && rounds_correctly(device);
    info.lanes = options.opencl_lanes != 0 ? options.opencl_lanes : (is_cpu ? 8 : 1);
    // PoCL keeps what it compiles itself, and compiles all once more for a binary.
    const BuildOptions build{info.lanes, options.strict_math, !target.is_pocl};
    target.programs = std::make_shared<Programs>(target.context, device, build);
    return target;
}

class OpenClDevice final : public Device {
public:
    explicit OpenClDevice(OpenClTarget target) : target_(std::move(target)) {}

    const DeviceInfo& info() const override { return target_.info; }

    std::unique_ptr<DeviceStream> open_stream(std::span<const TaskBody* const> bodies) override {
        return std::make_unique<OpenClStream>(target_, bodies);
    }

private:
    OpenClTarget target_;
};

/// Sub-devices in the order of `parts`, from the first unit on.
std::vector<cl::Device> divide(cl::Device device, const std::vector<int>& parts) {
    const int units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    const int used = std::accumulate(parts.begin(), parts.end(), 0);
    if (parts.size() == 1 && used == units) return {device};
    std::vector<cl_device_partition_property> properties{CL_DEVICE_PARTITION_BY_COUNTS};
    properties.insert(properties.end(), parts.begin(), parts.end());
    properties.push_back(CL_DEVICE_PARTITION_BY_COUNTS_LIST_END);
    properties.push_back(0);
    std::vector<cl::Device> divided;
    device.createSubDevices(properties.data(), &divided);
    return divided;
}

}  // namespace

std::vector<cl::Platform> opencl_platforms() {
    const ExtraDrivers drivers(usual_driver_places());
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {};  // the loader reports "no platform" as an error
    }
    return platforms;
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
    std::vector<cl::Device> devices;
    try {
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
        return {};  // a platform without devices
    }
    return devices;
}

std::string name_of(const cl::Platform& platform) {
    return trimmed(platform.getInfo<CL_PLATFORM_NAME>());
}

OpenClDeviceSummary summarise(const cl::Device& device) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    return {trimmed(device.getInfo<CL_DEVICE_NAME>()), name_of(platform),
            static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()),
            is_type(device, CL_DEVICE_TYPE_CPU), is_type(device, CL_DEVICE_TYPE_GPU)};
}

std::vector<OpenClDeviceSummary> opencl_devices() {
    std::vector<OpenClDeviceSummary> list;
    for (const cl::Device& device : all_devices()) list.push_back(summarise(device));
    return list;
}

std::vector<std::unique_ptr<Device>> open_opencl_device(int index, const std::vector<int>& parts,
                                                        const DeviceOptions& options, int team) {
    const cl::Device& whole = all_devices().at(static_cast<std::size_t>(index));
    std::vector<std::unique_ptr<Device>> opened;
    try {
        const auto devices = parts.empty() ? std::vector<cl::Device>{whole} : divide(whole, parts);
        for (const cl::Device& device : devices) {
            OpenClTarget target = describe(device, options);
            target.info.team = team;
            opened.push_back(std::make_unique<OpenClDevice>(std::move(target)));
        }
    } catch (const cl::Error& error) {
        if (error.err() == CL_DEVICE_PARTITION_FAILED || error.err() == CL_INVALID_VALUE) {
            throw UserError("opencl:" + std::to_string(index) +
                            " cannot be limited to a part of its compute units; leave out '/N'");
        }
        throw opencl_error("opening opencl:" + std::to_string(index), error);
    }
    return opened;
}

}  // namespace weft
