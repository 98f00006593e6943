#pragma once

#include "simulation/mesh/vec3.h"
#include "simulation/model/elements.h"

namespace weft {

/// Springs E = k/2 (|x0 - x1| - rest)^2 along edges, and between bodies that are attached to each
/// other.
struct Springs {
    Elements elements;
    Buffer<float> material;  ///< [2 * count] column-major: rest length [m], compliance 1/k [m/N]

    int edge_count;  ///< how many springs as given are edges; the rest are attachments

    /// rest: positions of all vertices (old order); stiffness: per spring, as given [N/m]
    Springs(const Stencils& springs, const Strips& strips, std::span<const Vec3> rest,
            std::span<const double> stiffness, int edges);

    bool is_edge(int spring) const { return elements.original(spring) < edge_count; }
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
