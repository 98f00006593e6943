#pragma once

#include <array>

#include "simulation/families/family.h"
#include "simulation/families/stiffness.h"

namespace weft {

/// A triangle in its own plane, as it is at rest: the first edge runs along u, v is across it [m].
struct FlatTriangle {
    double width;   ///< of the first edge
    double along;   ///< where the third corner is, along u
    double height;  ///< and along v
};
FlatTriangle laid_flat(const std::array<Vec3, 3>& corners);

/// Triangles of stable Neo-Hookean membrane: kernels/energies/membrane.h.
class Membranes final : public ElementFamily {
public:
    /// rest: per triangle, as given; stiffness: likewise [N/m]
    Membranes(const FamilyNames& names, const Stencils& triangles, const Strips& strips,
              std::span<const FlatTriangle> rest, std::span<const Stiffness> stiffness);

    /// u and v of the corner's b [1/m].
    std::array<double, 2> shape_gradient(int triangle, int corner) const;
    double mu(int triangle) const { return column(material, 0, triangle); }
    double lambda(int triangle) const { return column(material, 1, triangle); }

    std::vector<std::string> constraints() const override { return {".area", ".shape"}; }
    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    bool has_stencils() const override { return true; }
    std::unique_ptr<StencilSolve> make_stencils(const VertexLayout& items,
                                                const StencilLayout::Family& chosen) const override;
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double energy(int triangle, const Vec3* x) const override;
    void gradient(int triangle, const Vec3* x, Vec3* gradient) const override;
    void hessian(int triangle, const Vec3* x, Mat3* blocks) const override;
    void add_edges(std::vector<Edge>& edges) const override;

    Buffer<float> shape;     ///< [4 * count] column-major: b_1, b_2 [1/m], u and v of each
    Buffer<float> material;  ///< [2 * count] column-major: mu, lambda, times rest area [J]

private:
    double column(const Buffer<float>& table, int k, int triangle) const {
        return static_cast<double>(table[static_cast<std::size_t>(k * count() + triangle)]);
    }
};

}  // namespace weft
