#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>

namespace weft {

/// 128-bit hash of a sequence of words. It is no defence against forgery.
///
/// Two 64-bit lanes take each word by the step of FNV-1a and a rotation; they start from different
/// values, and each ends in the mixing of SplitMix64 (Steele, Lea, Flood 2014).
class WordHash {
public:
    void add(std::uint32_t word) {
        first_.add(word);
        second_.add(word);
    }

    /// 32 hex digits.
    std::string text() const {
        char text[33];
        std::snprintf(text, sizeof(text), "%016llx%016llx",
                      static_cast<unsigned long long>(first_.finished()),
                      static_cast<unsigned long long>(second_.finished()));
        return text;
    }

private:
    /// A product carries upwards only: without the rotation, high bits of a word would reach few
    /// bits of the hash. Each step is a bijection, so one changed word always changes the state.
    struct Lane {
        std::uint64_t state;

        void add(std::uint32_t word) {
            constexpr std::uint64_t kFnvPrime = 0x100000001b3;
            state = std::rotl((state ^ word) * kFnvPrime, 23);
        }
        std::uint64_t finished() const {
            std::uint64_t z = state;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
            z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
            return z ^ (z >> 31);
        }
    };

    Lane first_{0xcbf29ce484222325};   // where FNV-1a starts
    Lane second_{0x9e3779b97f4a7c15};  // the golden ratio's fraction
};

}  // namespace weft
