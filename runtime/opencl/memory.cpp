#include "runtime/opencl/memory.h"

#include <algorithm>
#include <stdexcept>

namespace weft {

namespace {

/// Mapped memory is the driver's, where it likes it best, and the host has its own beside it: while
/// a device works on some ranges, the host and others have to write into others, and what the host
/// writes into memory that is not mapped, a device need not see.
cl_mem_flags flags_of(MemoryModel memory) {
    switch (memory) {
        case MemoryModel::kHost:
            return CL_MEM_USE_HOST_PTR;
        case MemoryModel::kMapped:
            return CL_MEM_ALLOC_HOST_PTR | CL_MEM_COPY_HOST_PTR;
        case MemoryModel::kDiscrete:
            return CL_MEM_COPY_HOST_PTR;
    }
    throw std::logic_error("unknown memory model");
}

}  // namespace

cl::Buffer make_memory(const cl::Context& context, MemoryModel memory,
                       const BufferStorage& buffer) {
    // Zero copy asks for multiples of 64 bytes, and no size is 0. The host's memory has whole pages
    // (BufferStorage), so it does not end before that.
    const std::size_t bytes = std::max<std::size_t>((buffer.bytes() + 63) / 64 * 64, 64);
    return cl::Buffer(context, CL_MEM_READ_WRITE | flags_of(memory), bytes,
                      const_cast<void*>(buffer.host()));  // OpenCL has one pointer for both
}

}  // namespace weft
