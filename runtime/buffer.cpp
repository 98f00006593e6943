#include "runtime/buffer.h"

#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "runtime/error.h"

namespace weft {

namespace {

constexpr std::size_t kPage = 4096;  // what OpenCL drivers ask of memory that they use in place
constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Large buffers on large pages: gathers then miss the address caches less often.
void ask_for_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
    ::madvise(memory, bytes, MADV_HUGEPAGE);  // a hint
#endif
}

std::shared_ptr<void> zeroed_pages(std::size_t bytes) {
    const std::size_t page = bytes < kHugePage ? kPage : kHugePage;
    const std::size_t whole_pages = (bytes / page + 1) * page;
    std::shared_ptr<void> memory(std::aligned_alloc(page, whole_pages), std::free);
    if (memory == nullptr) throw std::bad_alloc();
    if (page == kHugePage) ask_for_huge_pages(memory.get(), whole_pages);
    std::memset(memory.get(), 0, whole_pages);
    return memory;
}

/// Items are numbered by ints; a negative count, which becomes a huge one, is not meant.
std::size_t countable(const std::string& name, std::size_t count) {
    if (count <= static_cast<std::size_t>(std::numeric_limits<int>::max())) return count;
    throw Misuse("buffer '" + name + "': it cannot have " + std::to_string(count) + " elements");
}

}  // namespace

BufferStorage::BufferStorage(std::string name, std::size_t count, std::size_t element_size)
    : name_(std::move(name)),
      count_(countable(name_, count)),
      element_size_(element_size),
      host_(zeroed_pages(bytes())) {}

void BufferStorage::resize(std::size_t count) {
    count_ = countable(name_, count);
    host_ = zeroed_pages(bytes());
    ++generation_;
}

}  // namespace weft
