#pragma once

#include "simulation/scene/scene.h"

namespace weft {

/// The two moduli of the stable Neo-Hookean energies in kernels/energies/: of a solid [Pa], of a
/// sheet [N/m].
struct Stiffness {
    double mu = 0.0;
    double lambda = 0.0;
};

/// The energy without the logarithm is linear elasticity at rest for mu = mu_L, lambda = lambda_L +
/// mu_L. (The one with it needs mu = 4/3 mu_L and lambda = lambda_L + 5/6 mu_L.) lambda is positive
/// for every Poisson's ratio between -1 and 1/2.
inline Stiffness stiffness_of(const Material& material) {
    const double mu = material.young / (2.0 * (1.0 + material.poisson));
    return {mu, mu / (1.0 - 2.0 * material.poisson)};
}

/// Plane stress, for which lambda_L = 2 mu_L nu / (1 - nu).
inline Stiffness stiffness_of(const Membrane& membrane) {
    const double nu = membrane.material.poisson;
    const double mu = membrane.thickness * membrane.material.young / (2.0 * (1.0 + nu));
    return {mu, mu * (1.0 + nu) / (1.0 - nu)};
}

}  // namespace weft
