#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device.h"
#include "runtime/opencl/entry_style.h"

namespace weft {

/// How devices are opened.
struct DeviceOptions {
    bool strict_math = true;
    /// Instead of what the device says of itself; for tests and odd drivers.
    std::optional<MemoryModel> memory;
    /// Items per call of a kernel on OpenCL devices (1 or 8), and on the CPU (1, 8 or 16: at the
    /// most, as the processor has them); 0 = what suits the device.
    int opencl_lanes = 0;
    int cpu_lanes = 0;
    /// Of OpenCL devices, instead of what suits the device. group_size: work-items of a group
    /// (kPerGroup); 0 = as many as the device can have
    std::optional<EntryStyle> entry_style;
    int group_size = 0;
};

/// Opens the devices that a list such as "cpu/1+opencl:0/1" names, in its order:
///   cpu, cpu/N            TBB on all free cores, or on N
///   opencl                the first GPU, or else the first OpenCL device
///   opencl:I, opencl:I/N  device I of `weft devices`, whole or limited to N compute units
///   opencl:NAME           the first whose name, or whose platform's, holds it; any case
///   gpu                   the first GPU
///   hybrid                the CPU and the best OpenCL device; the CPU alone where there is none;
///                         where the device is the CPU itself, or else the CPU alone
/// '+' stands between devices that work together, a team; '|' between teams, of which one works at
/// a time: "cpu/1+opencl:0/1|cpu" is a core by TBB and one by OpenCL, or all by TBB. OpenCL devices
/// that are the CPU itself and the TBB devices get cores of their own. Throws UserError for a list
/// that cannot be had. OpenCL is not touched unless the list asks for it.
std::vector<std::unique_ptr<Device>> open_devices(const std::string& list,
                                                  const DeviceOptions& options = {});

/// Throws UserError where a list is not well formed. No device is looked for: the machine that it
/// is meant for may be another one.
void check_device_list(const std::string& list);

/// Whether OpenCL is asked for such a list's devices. Throws likewise.
bool touches_opencl(const std::string& list);

/// Every single device of this machine as list elements: "cpu", "opencl:0", ...
std::vector<std::string> available_devices();

/// The list that "hybrid" stands for on this machine.
std::string hybrid_devices();

}  // namespace weft
