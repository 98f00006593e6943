#include "simulation/model/contact_thickness.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

namespace weft {

namespace {

/// Of cloths and solids. An edge inside a surface counts twice, one at a border once.
double mean_edge(const Gathered& all) {
    double sum = 0.0;
    const std::size_t count =
        all.triangles.size() - static_cast<std::size_t>(all.obstacle_triangles.count());
    for (const auto& t : std::span(all.triangles).first(count)) {  // obstacles come last
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = static_cast<std::size_t>(t[k]);
            const auto b = static_cast<std::size_t>(t[(k + 1) % 3]);
            sum += length(all.rest[b] - all.rest[a]);
        }
    }
    return sum / static_cast<double>(3 * count);
}

}  // namespace

void choose_thickness(Contact& contact, const Gathered& all, Warnings& warnings) {
    const double edge = mean_edge(all);
    if (contact.thickness == 0.0) contact.thickness = 0.25 * edge;
    if (contact.thickness <= 0.5 * edge) return;
    warnings.push_back(fmt::format(
        "contact.thickness = {:.3g} m is more than half of the mean edge ({:.3g} m): a surface may "
        "push its own neighbours; a quarter of the edge is a good choice, or a finer mesh",
        contact.thickness, edge));
}

double contact_floor(double thickness, double reach) {
    constexpr double kUlp = std::numeric_limits<float>::epsilon();
    return std::max(0.1 * thickness, 64.0 * kUlp * reach);
}

}  // namespace weft
