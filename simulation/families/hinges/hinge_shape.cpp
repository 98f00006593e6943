#include "simulation/families/hinges/hinge_shape.h"

#include <cmath>

namespace weft {

namespace {

double cotangent(Vec3 a, Vec3 b) { return dot(a, b) / length(cross(a, b)); }

/// The unit vector from an edge to a tip, at right angles to the edge.
Vec3 across(Vec3 edge, Vec3 to_tip) { return normalized(cross(cross(edge, to_tip), edge)); }

}  // namespace

std::array<double, 4> hinge_weights(const HingeCorners& x) {
    const Vec3 e0 = x[1] - x[0];
    const Vec3 e1 = x[2] - x[0];
    const Vec3 e2 = x[3] - x[0];
    const Vec3 e3 = x[2] - x[1];
    const Vec3 e4 = x[3] - x[1];
    const double c01 = cotangent(e0, e1);
    const double c02 = cotangent(e0, e2);
    const double c03 = cotangent(-e0, e3);
    const double c04 = cotangent(-e0, e4);
    const double area = 0.5 * (length(cross(e0, e1)) + length(cross(e0, e2)));
    const double scale = std::sqrt(3.0 / area);
    return {scale * (c03 + c04), scale * (c01 + c02), scale * (-c01 - c03), scale * (-c02 - c04)};
}

HalfFold half_fold(const HingeCorners& x) {
    const Vec3 edge = x[1] - x[0];
    const Vec3 u = across(edge, x[2] - x[0]);
    const Vec3 v = across(edge, x[3] - x[0]);
    const Vec3 normal = cross(normalized(edge), u - v);  // twice the cosine long
    const double twice_cosine = length(normal);
    if (twice_cosine == 0.0) return {0.0, 1.0};  // folded shut, to whichever side
    return {0.5 * twice_cosine, -0.5 * dot(u + v, normal) / twice_cosine};
}

std::array<double, 6> curved_hinge_weights(const HingeCorners& corners) {
    const auto q = hinge_weights(corners);
    const HalfFold fold = half_fold(corners);
    // The sums of cotangents in q_2 and q_3 are those of the unit vectors across the edge, too.
    const double twist = fold.sine / length(corners[1] - corners[0]);
    return {fold.cosine * q[1], fold.cosine * q[2], fold.cosine * q[3],
            twist * q[2],       -twist * q[3],      0.0};
}

}  // namespace weft
