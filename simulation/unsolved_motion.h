#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/platform.h"

namespace weft {

class Model;

/// Finds bodies that seem to move, but only give way to steps that are solved too little. Gravity
/// does it, so there is no energy from nowhere, and stiff bodies sag with hardly any strain. There
/// are two signs of it, both by what a single step would do if it were solved to its end:
///
/// - It would take back a good part of the farthest way that a body has ever been from where it
///   started. What moves by itself has gone farther after a few steps than any one of them can be
///   wrong.
/// - It would take back most of the strain, and all of the way can come from that: where edges are
///   longer by a part e, a taut strip of length L hangs through by L sqrt(3 e / 8).
class UnsolvedMotion {
public:
    struct Found {
        std::size_t body;      ///< of the model's
        double moved, undone;  ///< [m] RMS: the farthest way, and by the solved step
    };

    /// From where everything is now.
    explicit UnsolvedMotion(const Model& model);

    /// At a frame's end: how far everything is from where it started.
    void note(const Model& model);
    /// The body of which most would be taken back, if any. solved: where a step would have led to
    /// that led to where everything is, xyz in scene order [m]
    std::optional<Found> find(const Model& model, std::span<const float> solved) const;
    /// How far everything is [m] (RMS), if strain that the solved step does not have can make all
    /// of it; both of edges, RMS.
    std::optional<double> find(const Model& model, double strain, double solved) const;
    /// Of everything where it started: the diagonal of the box around it [m].
    double size() const { return size_; }

private:
    /// Where one body started.
    struct Start {
        std::vector<float4> places;  ///< of some of its vertices that move freely
        std::vector<int> vertices;   ///< these
        double mass = 0.0;           ///< of all that do [kg]
        double size = 0.0;           ///< the diagonal of the box around it [m]
    };

    /// Ways, RMS [m].
    struct Moved {
        std::vector<double> bodies;
        double all = 0.0;
    };
    /// To where everything is.
    Moved moved(const Model& model) const;

    std::vector<Start> starts_;  ///< [bodies]
    double size_ = 0.0;
    Moved most_;  ///< at the ends of frames until now
};

}  // namespace weft
