#pragma once

#include <memory>

#include "runtime/owned.h"
#include "simulation/families/family.h"

namespace weft {

/// A stitch as the scene has it.
struct StitchMaterial {
    double start;      ///< distance of its ends at time 0 [m]
    double stiffness;  ///< [N/m]
    double rate;       ///< one over the time that it takes to close [1/s]
};

/// Stitches of seams: kernels/energies/stitch.h.
class Stitches final : public ElementFamily {
public:
    /// materials: per stitch, as given
    Stitches(const FamilyNames& names, const Stencils& stitches, const Strips& strips,
             std::span<const StitchMaterial> materials);

    double start(int stitch) const { return column(0, stitch); }
    double stiffness(int stitch) const { return 1.0 / column(1, stitch); }
    double rate(int stitch) const { return column(2, stitch); }

    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    int block_columns() const override { return 6; }
    bool brings_together() const override { return true; }
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    void reserve(int substeps) override;
    void place(double time, double h) override;
    BufferStorage* placed_buffer() override { return clock.get(); }
    // At the end of the placed frame's first substep.
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double sum_energies_at(double time, int begin, int end,
                           std::span<const float4> positions) const override;
    double energy(int stitch, const Vec3* x) const override;
    void gradient(int stitch, const Vec3* x, Vec3* gradient) const override;
    void hessian(int stitch, const Vec3* x, Mat3* blocks) const override;

    std::optional<Tie> tie(int stitch) const override {
        return Tie{start(stitch), rate(stitch), stiffness(stitch)};
    }

    Buffer<float> material;  ///< [3 * count] column-major: start [m], compliance [m/N], rate [1/s]
    Owned<Buffer<float>> clock;  ///< [substeps] time at their ends [s]

private:
    double column(int k, int stitch) const {
        return static_cast<double>(material[static_cast<std::size_t>(k * count() + stitch)]);
    }
};

}  // namespace weft
