#include "runtime/unused_memory.h"

#include <sys/mman.h>

#include <cstddef>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace weft {

namespace {

constexpr int kLarge = 2 << 20;  ///< [B] below, it is not worth a page fault

}  // namespace

void give_back([[maybe_unused]] BufferStorage& buffer) {
#ifdef __linux__
    // Such buffers begin with a page, and are followed by room of their own (buffer.h).
    if (buffer.bytes() >= std::size_t{kLarge})
        ::madvise(buffer.host(), buffer.bytes(), MADV_DONTNEED);
#endif
}

void give_back_large_lists() {
#ifdef __GLIBC__
    ::mallopt(M_MMAP_THRESHOLD, kLarge);
    ::mallopt(M_TRIM_THRESHOLD, 2 * kLarge);
#endif
}

void give_back_freed() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

}  // namespace weft
