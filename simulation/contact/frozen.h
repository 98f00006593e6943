#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/contact/rows.h"
#include "simulation/mesh/vec3.h"

namespace weft {

/// A contact as a substep found it, in double precision: its gap is linear in the positions.
struct FrozenContact {
    std::array<int, 4> corners;     ///< vertices, new order
    std::array<double, 4> weights;  ///< sum 0
    Vec3 normal;
    double range = 0.0;      ///< [m]
    double stiffness = 0.0;  ///< [N/m]

    /// [m]; x: all vertices
    double gap(std::span<const Vec3> x) const;
    double energy(double gap) const;     ///< [J]
    double slope(double gap) const;      ///< dE/dg [N]
    double curvature(double gap) const;  ///< d2E/dg2 [N/m]
};

/// All contacts in the rows, each once. The host has the rows. positions: w = 1/mass
std::vector<FrozenContact> frozen_contacts(const ContactRows& rows,
                                           std::span<const float4> positions);

}  // namespace weft
