#pragma once

#include "simulation/mesh/vec3.h"
#include "simulation/model/elements.h"

namespace weft {

/// Springs E = k/2 (|x0 - x1| - rest)^2 along edges.
struct Springs {
    Elements elements;
    Buffer<float> material;  ///< [2 * count] column-major: rest length [m], compliance 1/k [m/N]

    /// rest: positions of all vertices (old order); stiffness: per spring, as in `edges` [N/m]
    Springs(const Stencils& edges, const Strips& strips, std::span<const Vec3> rest,
            std::span<const double> stiffness);

    double rest_length(int spring) const {
        return static_cast<double>(material[static_cast<std::size_t>(spring)]);
    }
    double stiffness(int spring) const {
        return 1.0 /
               static_cast<double>(material[static_cast<std::size_t>(elements.count() + spring)]);
    }
    /// [J], in double precision.
    double energy(std::span<const float4> positions) const;
};

}  // namespace weft
