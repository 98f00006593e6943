#include "runtime/buffer.h"

#include <cstdlib>
#include <cstring>
#include <utility>

namespace weft {

namespace {
constexpr std::size_t kPage = 4096;  // what OpenCL drivers ask of memory that they use in place
}

BufferStorage::BufferStorage(std::string name, std::size_t count, std::size_t element_size)
    : name_(std::move(name)), count_(count), element_size_(element_size) {
    const std::size_t whole_pages = (bytes() / kPage + 1) * kPage;
    host_ = std::aligned_alloc(kPage, whole_pages);
    if (host_ == nullptr) throw std::bad_alloc();
    std::memset(host_, 0, whole_pages);
}

BufferStorage::~BufferStorage() { std::free(host_); }

}  // namespace weft
