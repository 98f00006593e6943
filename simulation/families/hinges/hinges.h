#pragma once

#include <array>

#include "simulation/families/family.h"

namespace weft {

/// Quadratic bending over the hinges that are flat at rest.
class Hinges final : public ElementFamily {
public:
    /// weights: per hinge, as given; sqrt(stiffness) included [sqrt(J) / m]
    Hinges(const FamilyNames& names, const Stencils& hinges, const Strips& strips,
           std::span<const std::array<float, 4>> weights);

    /// Of the hinge's corner [sqrt(J) / m].
    double weight(int hinge, int corner) const {
        return static_cast<double>(weights[static_cast<std::size_t>(corner * count() + hinge)]);
    }

    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    int block_columns() const override { return 1; }
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    bool is_quadratic() const override { return true; }
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double energy(int hinge, const Vec3* x) const override;
    void gradient(int hinge, const Vec3* x, Vec3* gradient) const override;
    void hessian(int hinge, const Vec3* x, Mat3* blocks) const override;

    Buffer<float> weights;  ///< [4 * count] column-major, sqrt(stiffness) included [sqrt(J) / m]
};

}  // namespace weft
