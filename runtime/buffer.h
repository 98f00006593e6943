#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>

#include "kernels/platform.h"
#include "kernels/registry.h"

namespace weft {

/// The host's copy of a buffer: its home. Page-aligned, zeroed, and padded so that devices which
/// share the host's memory can use it in place. Large ones take memory where they are touched.
/// Device copies belong to the devices.
class BufferStorage {
public:
    /// Throws Misuse for more elements than an int can number.
    BufferStorage(std::string name, std::size_t count, std::size_t element_size);
    ~BufferStorage() { *alive_ = false; }
    BufferStorage(const BufferStorage&) = delete;
    BufferStorage& operator=(const BufferStorage&) = delete;

    const std::string& name() const { return name_; }
    std::size_t count() const { return count_; }
    std::size_t element_size() const { return element_size_; }
    std::size_t bytes() const { return count_ * element_size_; }
    void* host() { return host_.get(); }
    const void* host() const { return host_.get(); }

    /// Another size, between frames: with zeros or what was there before, maybe elsewhere in
    /// memory. Executors that know the buffer have to be told (Executor::rebind).
    void resize(std::size_t count);
    /// Zeros, as at the beginning, likewise.
    void clear();
    /// How often one of these has happened.
    int generation() const { return generation_; }
    /// The memory for who may need it a little longer than the buffer has it: a driver.
    std::shared_ptr<const void> memory() const { return host_; }
    /// Whether the buffer is still there, for those who would use it.
    std::shared_ptr<const bool> alive() const { return alive_; }

private:
    std::string name_;
    std::size_t count_;
    std::size_t element_size_;
    std::size_t room_;  ///< [B]
    std::shared_ptr<void> host_;
    std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
    int generation_ = 0;
};

/// A typed array: the only way data reaches a kernel. T is float, int, float4, or a struct of such
/// values that is written in C (kernels/members.h): no more than 4 bytes may be its alignment, but
/// for float4 in it.
///
/// The host may read and write data() between frames only; while an executor runs, the devices own
/// it. Buffers must outlive the executors that use them: a run without one of them throws Misuse.
template <class T>
class Buffer : public BufferStorage {
    static_assert(std::is_same_v<T, float> || std::is_same_v<T, int> ||
                      (std::is_class_v<T> && std::is_trivially_copyable_v<T> &&
                       (alignof(T) == alignof(float) || alignof(T) == alignof(float4)) &&
                       sizeof(T) % sizeof(float) == 0),
                  "a buffer holds float, int, float4, or plain structs of these");

public:
    Buffer(std::string name, std::size_t count)
        : BufferStorage(std::move(name), count, sizeof(T)) {}

    T* data() { return static_cast<T*>(host()); }
    const T* data() const { return static_cast<const T*>(host()); }
    T& operator[](std::size_t i) { return data()[i]; }
    const T& operator[](std::size_t i) const { return data()[i]; }
    std::span<T> span() { return {data(), count()}; }
    std::span<const T> span() const { return {data(), count()}; }
};

}  // namespace weft
