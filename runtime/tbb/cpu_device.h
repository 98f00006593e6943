#pragma once

#include <memory>
#include <vector>

#include "runtime/device.h"

namespace weft {

/// A TBB arena of `threads` threads. With `cores`, its threads stay on these cores.
/// lanes: 8 for the packed kernels, 1 for the scalar ones.
std::unique_ptr<Device> make_cpu_device(int threads, std::vector<int> cores, int lanes = 8,
                                        int team = 0);

}  // namespace weft
