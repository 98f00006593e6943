#include "simulation/mesh/winding.h"

#include <cmath>
#include <numbers>

namespace weft {

double winding_number(const PlainSurface& surface, int begin, int end, Vec3 point) {
    double angle = 0.0;
    for (int t = begin; t < end; ++t) {
        const Vec3 a = surface.corner(t, 0) - point;
        const Vec3 b = surface.corner(t, 1) - point;
        const Vec3 c = surface.corner(t, 2) - point;
        const double la = length(a), lb = length(b), lc = length(c);
        angle += 2.0 * std::atan2(dot(a, cross(b, c)),
                                  la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return angle / (4.0 * std::numbers::pi);
}

}  // namespace weft
