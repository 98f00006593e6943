#include "simulation/contact/notches.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft {

namespace {

constexpr double kAny = 100.0;  ///< more than all turns of a border [rad]

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Of a triangle, at corner k [rad].
double angle(const Surface& s, int triangle, std::size_t k, const std::vector<Vec3>& rest) {
    const auto& corners = s.triangles[at(triangle)];
    const auto place = [&](std::size_t n) { return rest[at(s.vertices[at(corners[n % 3])])]; };
    const Vec3 a = place(k + 1) - place(k);
    const Vec3 b = place(k + 2) - place(k);
    return std::atan2(length(cross(a, b)), dot(a, b));
}

double notch(const Surface& s, int vertex, const std::vector<Vec3>& rest) {
    int border_edges = 0;
    double sum = 0.0;
    for (const int t : s.triangles_at[vertex]) {
        const auto& corners = s.triangles[at(t)];
        for (std::size_t k = 0; k < 3; ++k) {
            if (corners[k] == vertex)
                sum += angle(s, t, k, rest);
            else
                border_edges += s.beyond[at(t)][k] < 0 ? 1 : 0;
        }
    }
    if (border_edges == 0) return 0.0;
    return border_edges == 2 ? std::max(sum - std::numbers::pi, 0.0) : kAny;
}

}  // namespace

std::vector<double> border_notches(const Surface& surface, const std::vector<Vec3>& rest) {
    std::vector<double> notches;
    for (int v = 0; v < surface.vertex_count(); ++v) notches.push_back(notch(surface, v, rest));
    return notches;
}

bool leave_no_slit(double first, double between, double second) {
    return (first + second) + between <= std::numbers::pi / 3.0;
}

}  // namespace weft
