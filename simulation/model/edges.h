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

/// The edges of all cloths and solids, each once, whatever elements lie along it. One measure of
/// strain for all of them: in double precision and one order, so the same for the same bits.
class Edges {
public:
    explicit Edges(std::span<const Owned<ElementFamily>> families);

    /// Of all edges. positions: [vertices] in the new order
    Strain strain(std::span<const float4> positions) const;
    /// The worst edge, if it is stretched to more than 1 + `most` times its length.
    std::optional<BadState> find_overstretched(std::span<const float4> positions,
                                               const Strain& strain, double most) const;
    /// At rest [m]; 0: there is none.
    double shortest() const;
    int count() const { return static_cast<int>(edges_.size()); }

private:
    std::vector<Edge> edges_;
};

}  // namespace weft
