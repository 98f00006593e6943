#pragma once

#include <vector>

#include "runtime/opencl/opencl_device.h"

namespace weft {

/// What opencl_devices() would say, found out in a process of its own: this one stays without
/// OpenCL, so that limit_cpu_driver() can still be called.
std::vector<OpenClDeviceSummary> probe_opencl_devices();

/// Asks drivers that run OpenCL on the CPU for no more than `units` threads. PoCL wakes all of its
/// threads at every kernel, also those outside the sub-device in use; on the cores of TBB they cost
/// 25 us per kernel and disturb what runs there. Works only before OpenCL is used in this process.
/// Never ask for more than there are cores: PoCL would promise units that it does not have.
void limit_cpu_driver(int units);

}  // namespace weft
