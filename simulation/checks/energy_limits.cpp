#include "simulation/checks/energy_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "simulation/families/convert.h"

namespace weft {

namespace {

constexpr double kRounding = static_cast<double>(std::numeric_limits<float>::epsilon());

}  // namespace

double lift_by_size(const Model& model, int begin, int end) {
    Vec3 low = to_vec3((*model.positions)[static_cast<std::size_t>(begin)]);
    Vec3 high = low;
    double mass = 0.0;
    for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
        const Vec3 x = to_vec3((*model.positions)[v]);
        low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
        high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
        mass += model.masses[v];
    }
    return length(high - low) * length(model.scene.gravity_at(0.0)) * mass;
}

double energy_of_rounding(const Model& model) {
    constexpr auto kStep = static_cast<float>(kRounding);
    const auto now = model.positions->span();
    std::vector<float4> off(now.begin(), now.end());
    double moment = 0.0;  // [kg m^2]
    for (std::size_t v = 0; v < off.size(); ++v) {
        const auto by = [&](std::size_t k) { return (v * 7919 + k) % 5 < 3 ? kStep : -kStep; };
        const float4& x = now[v];
        off[v] = {x.x + by(0) * x.x, x.y + by(1) * x.y, x.z + by(3) * x.z, x.w};
        if (x.w > 0.0f) moment += model.masses[v] * dot(to_vec3(x), to_vec3(x));
    }
    double sum = 0.0;
    for (const auto& family : model.families) {
        sum += std::abs(family->total_energy(off) - family->total_energy(now));
    }
    return sum + 0.5 * moment * (kRounding / model.h) * (kRounding / model.h);
}

std::string there_was(double had, double lifted) {
    if (lifted > 0.0) {
        return fmt::format(
            "where nothing was to be had: to be as high as it is takes {:.3g} J more than there "
            "was",
            lifted);
    }
    return fmt::format("where {:.3g} J were to be had", had);
}

}  // namespace weft
