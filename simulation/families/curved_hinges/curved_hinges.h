#pragma once

#include <array>

#include "simulation/families/family.h"

namespace weft {

/// Bending over the hinges that are folded at rest: kernels/energies/curved_hinge.h.
class CurvedHinges final : public ElementFamily {
public:
    /// Of a hinge, as seen from its first corner: q_1, q_2, q_3, p_12, p_13, p_23, stiffness
    /// included [sqrt(J) / m, sqrt(J) / m^2]; p_23 is 0.
    using Weights = std::array<double, 6>;

    /// weights: per hinge, as given; is_nearly_flat: folded so little at rest, on average, that a
    /// flat hinge's constant Hessian serves in a linear system, as on meshes that are fine enough
    /// for their curvature
    CurvedHinges(const FamilyNames& names, const Stencils& hinges, const Strips& strips,
                 std::span<const Weights> weights, bool is_nearly_flat);

    /// The same as seen from any corner: of the three that follow it, and of their pairs.
    Weights seen_from(int hinge, int corner) const;
    /// q of a corner.
    double weight(int hinge, int corner) const;
    /// p_jk of two corners, -p_kj.
    double pair_weight(int hinge, int j, int k) const;

    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    int block_columns() const override { return is_nearly_flat_ ? 1 : 9; }
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double energy(int hinge, const Vec3* x) const override;
    void gradient(int hinge, const Vec3* x, Vec3* gradient) const override;
    void hessian(int hinge, const Vec3* x, Mat3* blocks) const override;

    Buffer<float> weights;  ///< [6 * count] column-major

private:
    double column(int k, int hinge) const {
        return static_cast<double>(weights[static_cast<std::size_t>(k * count() + hinge)]);
    }
    bool is_nearly_flat_;
};

}  // namespace weft
