#pragma once

#include "runtime/trace/records.h"

namespace weft {

/// What this process runs on, for records: name, cpu, cores (that it may use), memory_bytes, os,
/// kernel. What the system does not tell is left out.
TextPairs host_info();

/// The compiler, and the libraries of the runtime.
TextPairs runtime_versions();

}  // namespace weft
