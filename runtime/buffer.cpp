#include "runtime/buffer.h"

#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include "runtime/error.h"

namespace weft {

namespace {

constexpr std::size_t kPage = 4096;  // what OpenCL drivers ask of memory that they use in place
constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Large buffers on large pages: gathers then miss the address caches less often. Not a last one
/// that would be emptier than half: there are dozens of buffers.
void ask_for_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    const std::size_t pages = (bytes + kHugePage / 2) / kHugePage;
    ::madvise(memory, pages * kHugePage, MADV_HUGEPAGE);  // a hint
#endif
}

/// Zeros that take memory, and time, only where they are touched.
std::shared_ptr<void> mapped_pages(std::size_t bytes) {
    const std::size_t mapped = bytes + 2 * kHugePage;  // with what lies beside whole pages
    void* const start =
        ::mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (start == MAP_FAILED) throw std::bad_alloc();
    void* aligned = start;
    std::size_t room = mapped;
    std::align(kHugePage, bytes, aligned, room);
    ask_for_huge_pages(aligned, bytes);
    return {aligned, [start, mapped](void*) { ::munmap(start, mapped); }};
}

std::shared_ptr<void> allocated_pages(std::size_t bytes) {
    std::shared_ptr<void> memory(std::aligned_alloc(kPage, bytes), std::free);
    if (memory == nullptr) throw std::bad_alloc();
    std::memset(memory.get(), 0, bytes);
    return memory;
}

/// More than that many bytes: drivers may look a little beyond the end.
std::size_t padded(std::size_t bytes) { return (bytes / kPage + 1) * kPage; }

std::shared_ptr<void> zeroed_pages(std::size_t bytes) {
    return bytes < kHugePage ? allocated_pages(bytes) : mapped_pages(bytes);
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
      room_(padded(bytes())),
      host_(zeroed_pages(room_)) {}

/// Who has grown will grow again: mapped pages that nobody touches cost nothing.
void BufferStorage::resize(std::size_t count) {
    count_ = countable(name_, count);
    ++generation_;
    if (padded(bytes()) <= room_) return;
    host_.reset();
    room_ = padded(2 * bytes());
    host_ = zeroed_pages(room_);
}

void BufferStorage::clear() {
    ++generation_;
    host_.reset();
    host_ = zeroed_pages(room_);
}

}  // namespace weft
