#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulation/contact/rows.h"
#include "simulation/contact/rubbing.h"
#include "simulation/mesh/vec3.h"

namespace weft {

/// A contact as a substep found it, in double precision. The way from one of its closest points to
/// the other is linear in the positions, sum_j w_j x_j, and all of its energy depends on that way.
/// What presses the two together is no variable for friction: it is given.
struct FrozenContact {
    std::array<int, 4> corners;     ///< vertices, new order
    std::array<double, 4> weights;  ///< sum 0
    Vec3 normal;
    double range = 0.0;      ///< [m]
    double stiffness = 0.0;  ///< [N/m]
    Rubbing rubbing;
    Vec3 earlier_slip;   ///< of the side of positive weights, when the substep began [m]
    double press = 0.0;  ///< that friction goes by [N]

    /// [m]; x: all vertices
    Vec3 way(std::span<const Vec3> x) const;
    Vec3 way(std::span<const float4> x) const;
    double gap(Vec3 way) const { return dot(normal, way); }  ///< [m]
    double energy(Vec3 way) const;                           ///< [J]
    Vec3 gradient(Vec3 way) const;                           ///< of the energy by the way [N]
    Mat3 hessian(Vec3 way) const;                            ///< likewise [N/m]; not negative
    double force(Vec3 way) const;                            ///< that presses the two apart [N]
};

/// The same contacts in another order of vertices. new_of: [vertices] the new number of each
std::vector<FrozenContact> with_corners(std::vector<FrozenContact> contacts,
                                        std::span<const int> new_of);

/// All contacts in the rows, each once, without anything that presses them. The host has the rows.
/// positions: w = 1/mass
std::vector<FrozenContact> frozen_contacts(const ContactRows& rows,
                                           std::span<const float4> positions, Rubbing rubbing);

/// The other way: rows for these contacts. The table gets room for them, its buffers may move.
/// targets: [vertices] x~, which tells where inertia leads
void fill_rows(const ContactRows& rows, std::span<const FrozenContact> contacts,
               std::span<const float4> positions, std::span<const float4> targets);

}  // namespace weft
