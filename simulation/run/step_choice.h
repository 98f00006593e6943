#pragma once

#include <optional>

#include "simulation/scene/scene.h"

namespace weft {

/// What a frame is made of.
struct Steps {
    int substeps = 0;
    int iterations = 0;  ///< of each substep
};

/// Chooses the steps while a run goes on: smaller ones where frames went bad, and iterations by the
/// scene's tolerance. In all of it, scene: the run's, with the steps of the last frame.
class StepChoice {
public:
    /// A run begins with the scene's steps; its iterations are the most that there will be.
    explicit StepChoice(const Scene& scene);

    /// Steps of half the size; none: they have become small enough.
    std::optional<Steps> halved(const Scene& scene) const;
    /// How many times the substeps that the run began with.
    int refinement(const Scene& scene) const { return scene.substeps / first_substeps_; }
    /// Whether a relative error is beyond the tolerance; never without one.
    static bool misses_tolerance(const Scene& scene, double error);
    /// Where it is: more iterations; none: there are as many as may be. Those of the scene count as
    /// too few from now on.
    std::optional<Steps> with_more_iterations(const Scene& scene);
    /// Fewer iterations, where far fewer seem to do for the tolerance, and did not fail before.
    std::optional<Steps> with_fewer_iterations(const Scene& scene, double error) const;

    /// That were seen to be too few for the tolerance; 0: none.
    int failed_iterations() const { return failed_iterations_; }
    /// Goes on with what an earlier run has seen.
    void resume(int failed_iterations) { failed_iterations_ = failed_iterations; }

private:
    int first_substeps_;
    int most_iterations_;
    int failed_iterations_ = 0;
};

}  // namespace weft
