#pragma once

#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "kernels/platform.h"

namespace weft::test {

/// Random numbers that are the same with every standard library.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}

    float real(float low, float high) {
        return low +
               (high - low) * static_cast<float>(engine_() >> 8) / static_cast<float>(1U << 24);
    }
    /// In [low, high].
    int integer(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }
    float4 point(float size) {
        return {real(-size, size), real(-size, size), real(-size, size), 0.0f};
    }
    /// 0 .. count - 1 in random order.
    std::vector<int> permutation(int count) {
        std::vector<int> list(static_cast<std::size_t>(count));
        std::iota(list.begin(), list.end(), 0);
        for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[engine_() % i]);
        return list;
    }

private:
    std::mt19937 engine_;
};

}  // namespace weft::test
