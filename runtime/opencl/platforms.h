#pragma once

#include <string>
#include <vector>

#include "runtime/opencl/api.h"
#include "runtime/opencl/opencl_device.h"

namespace weft {

// What asks drivers, in this process or in one that may end by it (probe.h).

std::vector<cl::Platform> opencl_platforms();
std::string name_of(const cl::Platform& platform);
/// None where the platform reports an error.
std::vector<cl::Device> devices_of(const cl::Platform& platform);
OpenClDeviceSummary summarise(const cl::Device& device);

}  // namespace weft
