#pragma once

#include <string>
#include <vector>

#include "runtime/opencl/platforms.h"

namespace weft {

/// A platform by its name. By its number where it did not live to tell its name: the order of
/// platforms need not be the same in every process.
struct OpenClPlatform {
    int number = -1;
    std::string name;
};

/// What a process of its own has found out about this machine's drivers. A driver that ends the
/// process that asks it (a missing entry point is enough) ends that one, and not this one, which
/// then leaves it out. Besides, this one stays without OpenCL meanwhile, so that limit_cpu_driver()
/// can still be called.
struct OpenClProbe {
    std::vector<OpenClDeviceSummary> devices;  ///< what opencl_devices() will say
    std::vector<OpenClPlatform> unusable;
    bool no_loader = false;             ///< looking for platforms is enough to end a process
    std::vector<std::string> troubles;  ///< what was left out and why, in words
};

/// All others.
std::vector<cl::Platform> usable_platforms(const std::vector<OpenClPlatform>& unusable);

/// Probes at the first call.
const OpenClProbe& probe_opencl();

/// Asks drivers that run OpenCL on the CPU for no more than `units` threads. PoCL wakes all of its
/// threads at every kernel, also those outside the sub-device in use; on the cores of TBB they cost
/// 25 us per kernel and disturb what runs there. Works only before OpenCL is used in this process.
/// Never ask for more than there are cores: PoCL would promise units that it does not have.
void limit_cpu_driver(int units);

}  // namespace weft
