#pragma once

#include "simulation/mesh/vec3.h"
#include "simulation/model/elements.h"
#include "simulation/model/stiffness.h"

namespace weft {

/// Tetrahedra of stable Neo-Hookean material: kernels/energies/tetrahedron.h.
struct Tetrahedra {
    Elements elements;
    Buffer<float> shape;     ///< [9 * count] column-major: b_1, b_2, b_3 [1/m]
    Buffer<float> material;  ///< [2 * count] column-major: mu, lambda, times rest volume [J]

    /// rest: positions of all vertices (old order); stiffness: per tetrahedron [Pa]
    Tetrahedra(const Stencils& tetrahedra, const Strips& strips, std::span<const Vec3> rest,
               std::span<const Stiffness> stiffness);

    /// b of the tetrahedron's corner [1/m].
    Vec3 shape_gradient(int tetrahedron, int corner) const;
    double mu(int tetrahedron) const { return column(material, 0, tetrahedron); }
    double lambda(int tetrahedron) const { return column(material, 1, tetrahedron); }
    /// [J], in double precision.
    double energy(std::span<const float4> positions) const;
    /// |F| / sqrt(3): the mean stretch, 1 at rest.
    double stretch(int tetrahedron, std::span<const float4> positions) const;

private:
    double column(const Buffer<float>& table, int k, int tetrahedron) const {
        return static_cast<double>(
            table[static_cast<std::size_t>(k * elements.count() + tetrahedron)]);
    }
};

}  // namespace weft
