#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/owned.h"
#include "simulation/families/family.h"

namespace weft {

/// How far edges are from their lengths at rest, |length / rest length - 1|.
struct Strain {
    double rms = 0.0;
    double most = 0.0;
};

/// Of edges [m]: in single precision where that has them all, as of springs.
class RestLengths {
public:
    explicit RestLengths(std::span<const Edge> edges);

    double operator[](std::size_t edge) const {
        return exact_.empty() ? static_cast<double>(single_[edge]) : exact_[edge];
    }

private:
    std::vector<float> single_;
    std::vector<double> exact_;  ///< empty: single_ has them
};

/// The edges of all cloths and solids, each once, whatever elements lie along it. One measure of
/// strain for all of them: in double precision and one order, so the same for the same bits.
class Edges {
public:
    explicit Edges(std::span<const Owned<ElementFamily>> families);

    /// Of all edges. positions: [vertices] in the new order
    Strain strain(std::span<const float4> positions) const;
    /// Of some edges: the squares added up, and the most.
    struct BlockStrain {
        double squares = 0.0;
        double most = 0.0;
    };
    BlockStrain strain_of_block(std::size_t begin, std::size_t end,
                                std::span<const float4> positions) const;
    /// Of all edges, from those of their blocks (parallel.h).
    Strain joined(std::span<const BlockStrain> blocks) const;
    /// The worst edge, if it is stretched to more than 1 + `most` times its length.
    std::optional<BadState> find_overstretched(std::span<const float4> positions,
                                               const Strain& strain, double most) const;
    /// At rest [m]; 0: there is none.
    double shortest() const;
    int count() const { return static_cast<int>(ends_.size()); }

private:
    struct Ends {
        int a, b;  ///< vertices, new order
    };
    explicit Edges(std::span<const Edge> edges);
    double length_of(std::size_t edge, std::span<const float4> positions) const;
    double strain_of(std::size_t edge, std::span<const float4> positions) const;

    std::vector<Ends> ends_;  ///< [edges]
    RestLengths rests_;
};

}  // namespace weft
