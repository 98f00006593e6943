#include "runtime/io/compression.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace weft {

namespace {

constexpr const char* kNames[] = {"none", "fast", "small"};  // in the order of the enum

}  // namespace

std::string_view name_of(Compression compression) {
    return kNames[static_cast<std::size_t>(compression)];
}

std::vector<std::string> compression_names() { return {std::begin(kNames), std::end(kNames)}; }

Compression compression_named(std::string_view name) {
    const auto* at = std::find(std::begin(kNames), std::end(kNames), name);
    if (at == std::end(kNames)) {
        throw std::logic_error("no compression is called '" + std::string(name) + "'");
    }
    return static_cast<Compression>(at - std::begin(kNames));
}

}  // namespace weft
