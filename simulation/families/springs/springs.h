#pragma once

#include <algorithm>
#include <vector>

#include "simulation/families/family.h"

namespace weft {

/// Springs E = k/2 (|x0 - x1| - rest)^2 along edges, and between bodies that are attached to each
/// other.
class Springs final : public ElementFamily {
public:
    /// lengths: at rest, per spring, as given [m]; compliances: likewise [m/N]; edges: how many
    /// springs as given are edges; the rest are attachments
    Springs(const FamilyNames& names, const Stencils& springs, const Strips& strips,
            std::span<const float> lengths, std::span<const float> compliances, int edges);

    bool is_edge(int spring) const { return !std::ranges::binary_search(attachments_, spring); }
    double rest_length(int spring) const {
        return static_cast<double>(material[static_cast<std::size_t>(spring)]);
    }
    double stiffness(int spring) const {
        return 1.0 / static_cast<double>(material[static_cast<std::size_t>(count() + spring)]);
    }

    /// Springs are edges; attachments count apart.
    std::vector<std::string> parts() const override;
    Launch project(const ProjectTarget& target) override;
    std::unique_ptr<DerivativeRows> make_rows(const VertexItems& items) override;
    Launch energy_terms(const TermTarget& target) override;
    int block_columns() const override { return 6; }
    std::unique_ptr<BlockRows> make_block_rows(const BlockList& list) override;
    bool has_stencils() const override { return true; }
    std::unique_ptr<StencilSolve> make_stencils(const VertexLayout& items,
                                                const StencilLayout::Family& chosen) const override;
    double sum_energies(int begin, int end, std::span<const float4> positions) const override;
    double energy(int spring, const Vec3* x) const override;
    void gradient(int spring, const Vec3* x, Vec3* gradient) const override;
    void hessian(int spring, const Vec3* x, Mat3* blocks) const override;
    /// Attachments are.
    std::optional<Tie> tie(int spring) const override;
    /// And they are no edges.
    void add_edges(std::vector<Edge>& edges) const override;

    Buffer<float> material;  ///< [2 * count] column-major: rest length [m], compliance 1/k [m/N]

private:
    std::vector<int> attachments_;  ///< ascending
};

}  // namespace weft
