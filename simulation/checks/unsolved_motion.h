#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "simulation/checks/body_starts.h"

namespace weft {

/// Finds bodies that seem to move, but only give way to steps that are solved too little. Gravity
/// does it, so there is no energy from nowhere, and stiff bodies sag with hardly any strain. There
/// are three signs of it, by what a single step would do if it were solved to its end:
///
/// - It would take back a good part of the farthest way that a body has ever been from where it
///   started. What moves by itself has gone farther after a few steps than any one of them can be
///   wrong.
/// - It would take back most of the strain, and all of the way can come from that: where edges are
///   longer by a part e, a taut strip of length L hangs through by L sqrt(3 e / 8).
/// - It would push a body as hard as a good part of gravity does. What a step leaves undone is
///   small in a short one, but it acts in every step: soft bodies sag until something else bears
///   it. How far that is takes more than a step to say: see find_misplaced().
class UnsolvedMotion {
public:
    struct Found {
        std::size_t body;      ///< of the model's
        double moved, undone;  ///< [m] the farthest way, and by what is solved
    };

    /// Of several bodies [m].
    struct Ways {
        double least, most;
    };

    /// From where everything is now.
    explicit UnsolvedMotion(const Model& model);

    /// At a frame's end: how far everything is from where it started.
    void note(const Model& model);
    /// Likewise, at the end of a frame of which those before were not noted.
    void resume(const Model& model);
    /// The body of which most would be taken back, if any (RMS). solved: where a step would have
    /// led to that led to where everything is, xyz in scene order [m]
    std::optional<Found> find(const Model& model, std::span<const float> solved) const;
    /// How far everything is [m] (RMS), if strain that the solved step does not have can make all
    /// of it; both of edges, RMS.
    std::optional<double> find(const Model& model, double strain, double solved) const;
    /// How far the middles of those bodies have been, at most, that the solved step would push, if
    /// any. borne: [bodies] 0: not these (borne_bodies.h). fallen: what gravity makes of a step [m]
    std::optional<Ways> pushed(const Model& model, std::span<const float> solved,
                               std::span<const char> borne, double fallen) const;
    /// The body whose middle is farthest off, as a part of the farthest that it has been, if any;
    /// not what is under way. settled: where everything would be, likewise, if what the step leaves
    /// undone acted on. gravity: [m/s^2]
    std::optional<Found> find_misplaced(const Model& model, std::span<const float> settled,
                                        std::span<const char> borne, double gravity) const;
    /// What would not be found, at a body that has been so far [m].
    static double hidden(double way);
    /// Of everything where it started: the diagonal of the box around it [m].
    double size() const { return starts_.size(); }

private:
    /// Ways [m].
    struct Moved {
        std::vector<double> bodies;  ///< RMS
        std::vector<Vec3> middles;   ///< of bodies
        double all = 0.0;            ///< RMS
    };
    /// To where everything is.
    Moved moved(const Model& model) const;
    double moved_lately(std::size_t body, Vec3 middle, double frames) const;

    BodyStarts starts_;
    double most_all_ = 0.0;  ///< at the ends of frames until now, and the following
    std::vector<double> most_bodies_, most_middles_;
    std::deque<std::vector<Vec3>> lately_;  ///< middles, the last frame's first
};

}  // namespace weft
