#include "simulation/model/contact_thickness.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "simulation/model/near_bodies.h"

namespace weft {

namespace {

constexpr double kLeast = 0.1;  ///< of the mean edge, if nobody asks for less

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
    constexpr double kOfShortest = 0.9, kMost = 0.25;
    return std::clamp(kOfShortest * lengths.shortest, kLeast * lengths.mean, kMost * lengths.mean);
}

/// What but few triangles are nearer to other bodies than at the start, or `within`, whichever is
/// less [m].
double gap_at_start(const Gathered& all, double within) {
    constexpr double kFew = 0.05;
    const std::vector<double> distances = distances_to_others(all, within);
    if (distances.empty()) return within;
    return distances[static_cast<std::size_t>(kFew * static_cast<double>(distances.size()))];
}

constexpr double kOfGap = 0.9;

/// What starts pressed together pushes itself apart. (Who is much nearer may get through each
/// other, which is told elsewhere: checks/start_contacts.h.)
void warn_of_pressing(double thickness, double gap, Warnings& warnings) {
    if (gap >= 0.99 * thickness || gap < 0.1 * thickness) return;
    warnings.push_back(fmt::format(
        "bodies start nearer to each other than contact.thickness = {:.3g} m, and contact pushes "
        "them apart at once: {:.3g} m is a thickness that does not, or larger gaps",
        thickness, kOfGap * gap));
}

}  // namespace

double good_thickness(std::span<const std::array<int, 3>> triangles, std::span<const Vec3> rest) {
    return triangles.empty() ? 0.0 : good_thickness(edge_lengths(triangles, rest));
}

void choose_thickness(Contact& contact, const Gathered& all, Warnings* warnings) {
    const bool is_open = contact.thickness == 0.0;
    if (!is_open && warnings == nullptr) return;
    const EdgeLengths edge = edge_lengths(all);
    const double good = good_thickness(edge);
    const double gap = gap_at_start(all, is_open ? good : contact.thickness);
    if (is_open) {
        contact.thickness = gap < good ? std::clamp(kOfGap * gap, kLeast * edge.mean, good) : good;
    }
    if (warnings == nullptr) return;
    warn_of_pressing(contact.thickness, gap, *warnings);
    if (contact.thickness <= 0.5 * edge.mean) return;
    warnings->push_back(fmt::format(
        "contact.thickness = {:.3g} m is more than half of the mean edge ({:.3g} m): a surface may "
        "push its own neighbours; {:.3g} m is a good choice, or a finer mesh",
        contact.thickness, edge.mean, good));
}

double contact_floor(double thickness, double reach) {
    constexpr double kUlp = std::numeric_limits<float>::epsilon();
    return std::max(0.1 * thickness, 64.0 * kUlp * reach);
}

}  // namespace weft
