#pragma once

#include "simulation/families/family.h"
#include "simulation/families/stiffness.h"

namespace weft {

/// Tetrahedra of stable Neo-Hookean material: kernels/energies/tetrahedron.h.
class Tetrahedra final : public ElementFamily {
public:
    /// rest: positions of all vertices (old order); stiffness: per tetrahedron [Pa]
    Tetrahedra(const FamilyNames& names, const Stencils& tetrahedra, const Strips& strips,
               std::span<const Vec3> rest, std::span<const Stiffness> stiffness);

    /// b of the tetrahedron's corner [1/m].
    std::array<double, 3> shape_gradient(int tetrahedron, int corner) const;
    double mu(int tetrahedron) const { return column(material, 0, tetrahedron); }
    double lambda(int tetrahedron) const { return column(material, 1, tetrahedron); }

    std::vector<std::string> constraints() const override { return {".volume", ".shape"}; }
    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    bool has_stencils() const override { return true; }
    std::unique_ptr<StencilSolve> make_stencils(const VertexLayout& items,
                                                const StencilLayout::Family& chosen) const override;
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double energy(int tetrahedron, const Vec3* x) const override;
    void gradient(int tetrahedron, const Vec3* x, Vec3* gradient) const override;
    void hessian(int tetrahedron, const Vec3* x, Mat3* blocks) const override;
    void add_edges(std::vector<Edge>& edges) const override;

    Buffer<float> shape;     ///< [9 * count] column-major: b_1, b_2, b_3 [1/m]
    Buffer<float> material;  ///< [2 * count] column-major: mu, lambda, times rest volume [J]

private:
    double column(const Buffer<float>& table, int k, int tetrahedron) const {
        return static_cast<double>(table[static_cast<std::size_t>(k * count() + tetrahedron)]);
    }
};

}  // namespace weft
