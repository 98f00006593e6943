#pragma once

#include <array>

#include "simulation/families/family.h"

namespace weft {

/// The warp's direction in a triangle, by its edges from corner 0 to 1 and to 2; any length.
using WarpDirection = std::array<double, 2>;

/// Warp, weft and shear stiffness [N/m].
using WovenStiffness = std::array<double, 3>;

/// Triangles of woven cloth: kernels/energies/woven.h.
class WovenCloth final : public ElementFamily {
public:
    /// edges: from the first corner to the others at rest [m]; warp, stiffness: all per triangle
    WovenCloth(const FamilyNames& names, const Stencils& triangles, const Strips& strips,
               std::span<const std::array<Vec3, 2>> edges, std::span<const WarpDirection> warp,
               std::span<const WovenStiffness> stiffness);

    /// Of the corner's b along warp and weft [1/m].
    std::array<double, 2> shape_gradient(int triangle, int corner) const;
    /// k: 0 warp, 1 weft, 2 shear; times the rest area [J]
    double stiffness(int triangle, int k) const { return column(material, k, triangle); }

    std::vector<std::string> constraints() const override { return {".warp", ".weft", ".shear"}; }
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

    Buffer<float> shape;     ///< [4 * count] column-major: b_1, b_2 [1/m], warp and weft of each
    Buffer<float> material;  ///< [3 * count] column-major: warp, weft, shear, times rest area [J]

private:
    double column(const Buffer<float>& table, int k, int triangle) const {
        return static_cast<double>(table[static_cast<std::size_t>(k * count() + triangle)]);
    }
};

}  // namespace weft
