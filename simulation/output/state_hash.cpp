#include "simulation/output/state_hash.h"

#include <bit>
#include <cstdint>

#include "runtime/io/word_hash.h"

namespace weft {

namespace {

void add_origin(WordHash& hash, const std::array<double, 3>& origin) {
    if (origin == std::array<double, 3>{}) return;
    for (const double value : origin) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        hash.add(static_cast<std::uint32_t>(bits));
        hash.add(static_cast<std::uint32_t>(bits >> 32));
    }
}

}  // namespace

std::string state_hash(std::span<const float> positions, std::span<const float> velocities) {
    WordHash hash;
    hash.add(static_cast<std::uint32_t>(positions.size() / 3));
    for (const float value : positions) hash.add(std::bit_cast<std::uint32_t>(value));
    for (const float value : velocities) hash.add(std::bit_cast<std::uint32_t>(value));
    return hash.text();
}

std::string state_hash(std::span<const int> rows, std::span<const float4> positions,
                       std::span<const float4> velocities, const std::array<double, 3>& origin) {
    WordHash hash;
    hash.add(static_cast<std::uint32_t>(rows.size()));
    for (const auto values : {positions, velocities}) {
        for (const int row : rows) {
            const float4& value = values[static_cast<std::size_t>(row)];
            for (const float x : {value.x, value.y, value.z}) {
                hash.add(std::bit_cast<std::uint32_t>(x));
            }
        }
    }
    add_origin(hash, origin);
    return hash.text();
}

}  // namespace weft
