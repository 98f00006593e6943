#include "simulation/output/state_hash.h"

#include <bit>
#include <cstdint>
#include <cstdio>

namespace weft {

namespace {

constexpr std::uint64_t kFnvPrime = 0x100000001b3;
constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325;
constexpr std::uint64_t kSecondStart = 0x9e3779b97f4a7c15;  // the golden ratio's fraction

/// A product carries upwards only: without the rotation, high bits of a word would reach few bits
/// of the hash. Each step is a bijection, so one changed word always changes the state.
class Lane {
public:
    explicit Lane(std::uint64_t start) : state_(start) {}

    void add(std::uint32_t word) { state_ = std::rotl((state_ ^ word) * kFnvPrime, 23); }

    /// The output function of SplitMix64 (Steele, Lea, Flood 2014).
    std::uint64_t finished() const {
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

private:
    std::uint64_t state_;
};

}  // namespace

std::string state_hash(std::span<const float> positions, std::span<const float> velocities) {
    Lane first(kFnvStart);
    Lane second(kSecondStart);
    const auto add = [&](std::uint32_t word) {
        first.add(word);
        second.add(word);
    };
    add(static_cast<std::uint32_t>(positions.size() / 3));
    for (const float value : positions) add(std::bit_cast<std::uint32_t>(value));
    for (const float value : velocities) add(std::bit_cast<std::uint32_t>(value));

    char text[33];
    std::snprintf(text, sizeof(text), "%016llx%016llx",
                  static_cast<unsigned long long>(first.finished()),
                  static_cast<unsigned long long>(second.finished()));
    return text;
}

}  // namespace weft
