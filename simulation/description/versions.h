#pragma once

#include "runtime/trace/records.h"

namespace weft {

/// The libraries that simulations are made with, besides those of the runtime.
TextPairs simulation_versions();

}  // namespace weft
