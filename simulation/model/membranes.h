#pragma once

#include <array>

#include "simulation/mesh/vec3.h"
#include "simulation/model/elements.h"
#include "simulation/model/stiffness.h"

namespace weft {

/// Triangles of stable Neo-Hookean membrane: kernels/energies/membrane.h.
struct Membranes {
    Elements elements;
    Buffer<float> shape;     ///< [4 * count] column-major: b_1, b_2 [1/m], u and v of each
    Buffer<float> material;  ///< [2 * count] column-major: mu, lambda, times rest area [J]

    /// rest: positions of all vertices (old order); stiffness: per triangle [N/m]
    Membranes(const Stencils& triangles, const Strips& strips, std::span<const Vec3> rest,
              std::span<const Stiffness> stiffness);

    /// u and v of the corner's b [1/m].
    std::array<double, 2> shape_gradient(int triangle, int corner) const;
    double mu(int triangle) const { return column(material, 0, triangle); }
    double lambda(int triangle) const { return column(material, 1, triangle); }
    /// [J], in double precision.
    double energy(std::span<const float4> positions) const;
    /// |F| / sqrt(2): the mean stretch, 1 at rest.
    double stretch(int triangle, std::span<const float4> positions) const;

private:
    double column(const Buffer<float>& table, int k, int triangle) const {
        return static_cast<double>(
            table[static_cast<std::size_t>(k * elements.count() + triangle)]);
    }
};

}  // namespace weft
