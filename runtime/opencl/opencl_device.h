#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device.h"
#include "runtime/device_list.h"

namespace weft {

/// What is known of an OpenCL device before it is opened. Its index in the list is its number in
/// device lists.
struct OpenClDeviceSummary {
    std::string name;
    std::string platform;
    int units = 0;
    bool is_cpu = false;
    bool is_gpu = false;
};

/// All devices of all platforms but those that end the process that asks them; none where there is
/// no platform. Initialises OpenCL at the first call.
std::vector<OpenClDeviceSummary> opencl_devices();

/// What of this machine's OpenCL had to be left out so far, and why, in words. Asks no driver.
std::vector<std::string> opencl_troubles();

/// Opens device `index` of opencl_devices(). With `parts`, the device is divided into sub-devices
/// of so many compute units each, from its first unit on, and one device is opened per part.
std::vector<std::unique_ptr<Device>> open_opencl_device(int index, const std::vector<int>& parts,
                                                        const DeviceOptions& options, int team = 0);

}  // namespace weft
