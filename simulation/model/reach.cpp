#include "simulation/model/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {

double reach_of(std::span<const float4> positions) {
    float most = 0.0f;
    for (const float4& x : positions) {
        most = std::max({most, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
    return static_cast<double>(most);
}

double rounding_at(double reach) {
    return 0.5 * static_cast<double>(std::numeric_limits<float>::epsilon()) * reach;
}

}  // namespace weft
