#pragma once

#include "kernels/bodies/moments.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {

/// What friction holds has mass: of a point somewhere, or of nothing.
/// parts  of one row of moments, of which the next one is `stride` further
inline void hold_a_point(KernelCase& c, float4* parts, int stride) {
    const float part = c.random.integer(0, 1) == 0 ? 0.0f : c.random.real(0.0f, 0.5f);
    const float4 r = c.random.point(1.0f);
    const auto at = [&](int k) -> float4& {
        return parts[static_cast<std::ptrdiff_t>(k) * stride];
    };
    at(8) = {part * r.x, part * r.y, part * r.z, part};
    at(9) = {part * r.x * r.x, part * r.x * r.y, part * r.x * r.z, 0.0f};
    at(10) = {part * r.y * r.y, part * r.y * r.z, part * r.z * r.z, 0.0f};
}

}  // namespace weft::test
