#pragma once

#include "runtime/buffer.h"
#include "runtime/device.h"
#include "runtime/opencl/api.h"

namespace weft {

/// A device's memory of a buffer, with what the host has in it.
cl::Buffer make_memory(const cl::Context& context, MemoryModel memory, const BufferStorage& buffer);

}  // namespace weft
