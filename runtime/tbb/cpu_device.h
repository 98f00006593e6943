#pragma once

#include <memory>
#include <vector>

#include "runtime/device.h"

namespace weft {

/// A TBB arena of `threads` threads. With `cores`, its threads stay on these cores.
/// lanes: at the most, see DeviceOptions.
std::unique_ptr<Device> make_cpu_device(int threads, std::vector<int> cores, int lanes = 0,
                                        int team = 0);

}  // namespace weft
