#pragma once

#include "runtime/launch.h"

namespace weft::test {

/// Runs items [begin, end) of a launch by one of the kernel's compiled forms.
void run_on_host(const Launch& launch, kernels::RangeFunction function, int begin, int end,
                 int instance = 0, int iteration = 0);

}  // namespace weft::test
