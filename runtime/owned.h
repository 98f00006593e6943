#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace weft {

/// A std::unique_ptr that hands on constness: what something const owns is const. So who has a
/// `const Model&` reads, and who writes into its buffers asks for a `Model&`.
template <class T>
class Owned {
public:
    Owned() = default;
    Owned(std::nullptr_t) {}  // NOLINT(google-explicit-constructor): as a pointer's
    template <class U>
    requires std::is_convertible_v<U*, T*> Owned(
        std::unique_ptr<U> pointer)  // NOLINT(google-explicit-constructor): likewise
        : pointer_(std::move(pointer)) {}

    T* get() { return pointer_.get(); }
    const T* get() const { return pointer_.get(); }
    T& operator*() { return *pointer_; }
    const T& operator*() const { return *pointer_; }
    T* operator->() { return pointer_.get(); }
    const T* operator->() const { return pointer_.get(); }
    explicit operator bool() const { return pointer_ != nullptr; }

    friend bool operator==(const Owned& owned, std::nullptr_t) { return !owned; }

private:
    std::unique_ptr<T> pointer_;
};

}  // namespace weft
