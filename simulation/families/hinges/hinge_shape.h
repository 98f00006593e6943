#pragma once

#include <array>

#include "simulation/mesh/vec3.h"

namespace weft {

/// Where a hinge's corners are: the edge's two vertices, the two opposite [m].
using HingeCorners = std::array<Vec3, 4>;

/// The weights K of Bergou et al. 2006 ("A quadratic bending model for inextensible surfaces")
/// times sqrt(3 / (A0 + A1)): the hinge's energy is k/2 |sum_j weight_j x_j|^2. The sum is zero for
/// a flat sheet.
std::array<double, 4> hinge_weights(const HingeCorners& corners);

/// Half of the angle by which a hinge is folded, from -90 to 90 degrees; 0: flat.
struct HalfFold {
    double cosine = 1.0;
    double sine = 0.0;

    /// Folds below this are lost in the rounding of positions in single precision.
    bool is_flat() const { return -1e-5 < sine && sine < 1e-5; }
};
HalfFold half_fold(const HingeCorners& corners);

/// The weights q_1, q_2, q_3, p_12, p_13, p_23 of kernels/energies/curved_hinge.h without the
/// stiffness [1/m, 1/m^2], for a hinge that is at rest as it lies. Those of a flat one are
/// hinge_weights() and zeros.
std::array<double, 6> curved_hinge_weights(const HingeCorners& corners);

}  // namespace weft
