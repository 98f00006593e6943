#pragma once

#include <string_view>

#include "kernels/registry.h"

namespace weft::test {

/// The packed form of a kernel, built for the baseline of the architecture: what the library uses
/// where the processor has nothing better.
kernels::RangeFunction baseline_packed(std::string_view kernel);

}  // namespace weft::test
