#include "simulation/families/in_double.h"

#include "simulation/model/triangle_distance.h"

#include <algorithm>
#include <cmath>

#include "kernels/contact/closest.h"

namespace weft {

namespace {

double from_corners(const Corners& a, const Corners& b) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : a) {
        const auto near = kernels::closest_vertex_triangle(to_real3(p), to_real3(b[0]),
                                                           to_real3(b[1]), to_real3(b[2]));
        least = std::min(least, near.square);
    }
    return least;
}

}  // namespace

double distance_of(const Corners& a, const Corners& b) {
    double least = std::min(from_corners(a, b), from_corners(b, a));
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const auto near = kernels::closest_edges(to_real3(a[i]), to_real3(a[(i + 1) % 3]),
                                                     to_real3(b[j]), to_real3(b[(j + 1) % 3]));
            least = std::min(least, near.square);
        }
    }
    return std::sqrt(least);
}

}  // namespace weft
