#include "simulation/model/hinges.h"

#include <cmath>

#include "simulation/model/convert.h"

namespace weft {

namespace {

double cotangent(Vec3 a, Vec3 b) { return dot(a, b) / length(cross(a, b)); }

}  // namespace

std::array<double, 4> hinge_weights(const std::array<Vec3, 4>& x) {
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

Hinges::Hinges(const Stencils& hinges, const Strips& strips, std::span<const Vec3> rest,
               std::span<const double> stiffness)
    : elements("hinges", hinges, strips),
      weights("hinges.weights", 4 * static_cast<std::size_t>(elements.count())) {
    const auto count = static_cast<std::size_t>(elements.count());
    for (std::size_t h = 0; h < count; ++h) {
        const int original = elements.original(static_cast<int>(h));
        std::array<Vec3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) {
            corners[k] = rest[static_cast<std::size_t>(hinges[original][k])];
        }
        const auto weight = hinge_weights(corners);
        const double root = std::sqrt(stiffness[static_cast<std::size_t>(original)]);
        for (std::size_t k = 0; k < 4; ++k) {
            weights[k * count + h] = static_cast<float>(root * weight[k]);
        }
    }
}

double Hinges::energy(std::span<const float4> positions) const {
    const auto count = static_cast<std::size_t>(elements.count());
    double sum = 0.0;
    for (std::size_t h = 0; h < count; ++h) {
        const auto corners = elements.vertices_of(static_cast<int>(h));
        Vec3 bend;
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 x = to_vec3(positions[static_cast<std::size_t>(corners[k])]);
            bend = bend + static_cast<double>(weights[k * count + h]) * x;
        }
        sum += 0.5 * dot(bend, bend);
    }
    return sum;
}

}  // namespace weft
