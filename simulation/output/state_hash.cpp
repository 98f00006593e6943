#include "simulation/output/state_hash.h"

#include <bit>
#include <cstdint>

#include "runtime/io/word_hash.h"

namespace weft {

std::string state_hash(std::span<const float> positions, std::span<const float> velocities) {
    WordHash hash;
    hash.add(static_cast<std::uint32_t>(positions.size() / 3));
    for (const float value : positions) hash.add(std::bit_cast<std::uint32_t>(value));
    for (const float value : velocities) hash.add(std::bit_cast<std::uint32_t>(value));
    return hash.text();
}

}  // namespace weft
