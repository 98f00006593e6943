#pragma once

#include <array>

#include "simulation/mesh/vec3.h"
#include "simulation/model/elements.h"

namespace weft {

/// The weights K of Bergou et al. 2006 ("A quadratic bending model for inextensible surfaces")
/// times sqrt(3 / (A0 + A1)): the hinge's energy is k/2 |sum_j weight_j x_j|^2. Zero for a flat
/// sheet. corners: the edge's two vertices, the two opposite.
std::array<double, 4> hinge_weights(const std::array<Vec3, 4>& corners);

/// Quadratic bending over the hinges.
struct Hinges {
    Elements elements;
    Buffer<float> weights;  ///< [4 * count] column-major, sqrt(stiffness) included [sqrt(J) / m]

    /// rest: positions of all vertices (old order); stiffness: per hinge [J]
    Hinges(const Stencils& hinges, const Strips& strips, std::span<const Vec3> rest,
           std::span<const double> stiffness);

    /// Of the hinge's corner [sqrt(J) / m].
    double weight(int hinge, int corner) const {
        return static_cast<double>(
            weights[static_cast<std::size_t>(corner * elements.count() + hinge)]);
    }
    /// [J], in double precision.
    double energy(std::span<const float4> positions) const;
};

}  // namespace weft
