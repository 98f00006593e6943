#include "simulation/output/state_hash.h"

#include <bit>
#include <cstdint>

#include "runtime/io/word_hash.h"

namespace weft {

std::string state_hash(std::span<const float> positions, std::span<const float> velocities,
                       const std::array<double, 3>& origin) {
    WordHash hash;
    hash.add(static_cast<std::uint32_t>(positions.size() / 3));
    for (const float value : positions) hash.add(std::bit_cast<std::uint32_t>(value));
    for (const float value : velocities) hash.add(std::bit_cast<std::uint32_t>(value));
    if (origin != std::array<double, 3>{}) {
        for (const double value : origin) {
            const auto bits = std::bit_cast<std::uint64_t>(value);
            hash.add(static_cast<std::uint32_t>(bits));
            hash.add(static_cast<std::uint32_t>(bits >> 32));
        }
    }
    return hash.text();
}

}  // namespace weft
