#pragma once

#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

/// What one writes without Weft: XPBD springs coloured over the whole mesh, one plain C++ loop per
/// colour, an array of structures. The yardstick of the springs benchmark.
class PlainSprings {
public:
    struct Particle {
        float x, y, z, inverse_mass;
    };
    struct Spring {
        int a, b;
        float rest_length, multiplier;
    };

    /// edges: arity 2
    PlainSprings(std::vector<Particle> particles, const Stencils& edges, float compliance);

    /// One sweep over all springs. inverse_h2: 1 / h^2 [1/s^2]
    void sweep(float inverse_h2);
    std::size_t spring_count() const { return springs_.size(); }

private:
    std::vector<Particle> particles_;
    std::vector<Spring> springs_;  ///< by colour
    float compliance_;
};

}  // namespace weft
