#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/platform.h"
#include "runtime/tbb/parallel.h"
#include "simulation/contact/frozen.h"
#include "simulation/scene/scene.h"

namespace weft {

class Device;
class Executor;
class Model;
class NewtonRefinement;

/// The two ends of one substep: xyz of all vertices in scene order, counted from the model's origin
/// [m], [m/s].
struct SubstepEnds {
    std::vector<float> positions, velocities;  ///< at its start
    std::vector<float> reached;                ///< positions at its end
    double time = 0.0;                         ///< of its start [s]
    /// [vertices] 1: something else than elements and inertia keeps it where it is; empty: none
    std::vector<char> held;
    std::vector<FrozenContact>
        contacts{};  ///< that it found where it began; corners in scene order
};

/// What is said of one substep.
struct StepEstimate {
    double relative_error;
    double left;  ///< E(x) - E* [J]
};

/// How far a substep was solved: an estimate of the relative error that `weft error` measures,
///
///     (E(x) - E*) / (E0 - E*),    E0 at x~,
///
/// by going on from x with Newton's method until what is left to gain is small against what was
/// gained. E* need only be known to a part of E(x) - E*, so a few conjugate gradients will do. The
/// host does it on a model of its own, so the numbers do not depend on devices.
class StepError {
public:
    /// scene: with its substeps. threads: to do it with
    StepError(const Scene& scene, int threads);
    ~StepError();

    /// Nothing where both x~ and x are as near to the minimum as single precision can tell. None
    /// where the numbers have no meaning.
    std::optional<StepEstimate> estimate(const SubstepEnds& ends);
    /// Where the last estimate's substep would have led to, xyz in scene order, counted from the
    /// model's origin [m].
    std::vector<float> solved() const;
    /// Likewise, where what the substep left undone would lead if it acted on for `longer` times
    /// its length: inertia holds as in a step so long, and soft bodies go far. Ends early where
    /// nothing seems to get as far as `visible` [m].
    std::vector<float> settled(const SubstepEnds& ends, double longer, double visible);
    /// Its relative error alone.
    std::optional<double> of(const SubstepEnds& ends);

private:
    struct Iteration;
    std::optional<StepEstimate> estimate_begun();
    void start_at(const SubstepEnds& ends, double longer = 1.0);
    void rest();
    double energy_at(std::span<const float4> positions) const;
    double energy_of_rounding(double reached) const;
    void take_contacts(const std::vector<FrozenContact>& contacts);
    void press_as_at(std::span<const float4> positions);
    double contact_energy_at(std::span<const float4> positions) const;
    void begin();
    double refine(double reached);
    double farthest_way() const;
    double gain_of_iteration(double least);

    HostThreads threads_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<NewtonRefinement> newton_;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Executor> executor_;
    std::vector<Iteration> iterations_;
    std::vector<float> inverse_masses_;  ///< [vertices] of the model

    // Of the estimate at hand; empty between two.
    double inertia_ = 0.0;  ///< of a unit of mass [1/s^2]
    /// [vertices] xyz, w as if masses made this inertia in a step of the model, 0 for held ones
    std::vector<float4> targets_, reached_;
    std::vector<FrozenContact> contacts_;
    bool rubs_ = false;  ///< some of them
    /// [vertices] where the iteration before ended, where that matters
    std::vector<float4> before_;
};

}  // namespace weft
