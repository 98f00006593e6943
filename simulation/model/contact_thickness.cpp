#include "simulation/model/contact_thickness.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace weft {

namespace {

/// Of the surfaces of cloths and solids. An edge inside a surface counts twice, one at a border
/// once.
struct EdgeLengths {
    double mean = 0.0, shortest = std::numeric_limits<double>::infinity();  ///< [m]
};

EdgeLengths edge_lengths(std::span<const std::array<int, 3>> triangles,
                         std::span<const Vec3> rest) {
    EdgeLengths lengths;
    for (const auto& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = static_cast<std::size_t>(t[k]);
            const auto b = static_cast<std::size_t>(t[(k + 1) % 3]);
            const double own = length(rest[b] - rest[a]);
            lengths.mean += own / static_cast<double>(3 * triangles.size());
            lengths.shortest = std::min(lengths.shortest, own);
        }
    }
    return lengths;
}

EdgeLengths edge_lengths(const Gathered& all) {
    const std::size_t count =
        all.triangles.size() - static_cast<std::size_t>(all.obstacle_triangles.count());
    return edge_lengths(std::span(all.triangles).first(count), all.rest);  // obstacles come last
}

/// A quarter of the mean edge. What is on both sides of an edge is as near to each other as it is
/// long, and should not push: in irregular meshes it is less for that, unless the edge is a
/// sliver's.
double good_thickness(const EdgeLengths& lengths) {
    constexpr double kOfShortest = 0.9, kLeast = 0.1, kMost = 0.25;
    return std::clamp(kOfShortest * lengths.shortest, kLeast * lengths.mean, kMost * lengths.mean);
}

}  // namespace

double good_thickness(std::span<const std::array<int, 3>> triangles, std::span<const Vec3> rest) {
    return triangles.empty() ? 0.0 : good_thickness(edge_lengths(triangles, rest));
}

void choose_thickness(Contact& contact, const Gathered& all, Warnings& warnings) {
    const EdgeLengths edge = edge_lengths(all);
    if (contact.thickness == 0.0) contact.thickness = good_thickness(edge);
    if (contact.thickness <= 0.5 * edge.mean) return;
    warnings.push_back(fmt::format(
        "contact.thickness = {:.3g} m is more than half of the mean edge ({:.3g} m): a surface may "
        "push its own neighbours; {:.3g} m is a good choice, or a finer mesh",
        contact.thickness, edge.mean, good_thickness(edge)));
}

double contact_floor(double thickness, double reach) {
    constexpr double kUlp = std::numeric_limits<float>::epsilon();
    return std::max(0.1 * thickness, 64.0 * kUlp * reach);
}

}  // namespace weft
