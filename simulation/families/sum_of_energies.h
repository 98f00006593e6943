#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "runtime/lane_sum.h"
#include "simulation/families/family.h"

namespace weft {

/// The loop behind ElementFamily::sum_energies(), where a family's own energy() and its number of
/// corners are known, so that no call is left in it. For functions that are WEFT_WIDE.
template <int kCorners, class Own>
double sum_of_energies(const Own& family, int begin, int end, std::span<const float4> positions) {
    constexpr int kAtOnce = 256;
    std::array<double, kAtOnce> terms;
    const int* const vertices = family.elements().vertices().data();
    const int count = family.count();
    LaneSum sum;
    for (int first = begin; first < end; first += kAtOnce) {
        const int own = std::min(kAtOnce, end - first);
        for (int i = 0; i < own; ++i) {
            std::array<Vec3, kCorners> x;
            for (int k = 0; k < kCorners; ++k) {
                const int vertex = vertices[k * count + first + i];
                const float4& p = positions[static_cast<std::size_t>(vertex)];
                x[static_cast<std::size_t>(k)] = {p.x, p.y, p.z};
            }
            terms[static_cast<std::size_t>(i)] = family.Own::energy(first + i, x.data());
        }
        sum.add({terms.data(), static_cast<std::size_t>(own)});
    }
    return sum.total();
}

}  // namespace weft
