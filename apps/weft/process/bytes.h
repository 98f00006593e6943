#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace weft {

/// Lists as the bytes that child processes answer with (child_process.h).
template <class T>
std::string bytes_of(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> from_bytes(const std::string& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

}  // namespace weft
