#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulation/checks/step_error.h"
#include "simulation/scene/scene.h"
#include "simulation/solver/async_settings.h"

namespace weft {

/// What asynchronous iterations lose: found out by trying one substep, from a given state, both
/// ways. It is computed on the host, and depends on nothing but the scene, the state and the map.
class AsyncLoss {
public:
    /// The state at the start of `frame`: xyz in scene order [m], [m/s].
    /// scene  with its substeps
    AsyncLoss(const Scene& scene, int frame, std::vector<float> positions,
              std::vector<float> velocities);
    ~AsyncLoss();

    /// How many iterations devices that take equally long need for the error that the synchronous
    /// solver reaches with the scene's, as a multiple of those that it needs itself: fewer than the
    /// scene's, where its error does not fall steadily. Infinite: more than kMost times the
    /// scene's. None: the step has nothing to solve, so nothing is known.
    std::optional<double> factor(const AsyncSettings& settings, int devices);

    static constexpr double kMost = 4.0;

private:
    /// Of the substep's end, after so many iterations; null: synchronous.
    std::optional<double> error_after(int iterations, const AsyncSettings* settings, int devices);
    std::optional<double> search(const AsyncSettings* settings, int devices);

    Scene scene_;  ///< of the substep alone
    SubstepEnds start_;
    int substep_;  ///< since the run's beginning
    int iterations_;
    StepError estimate_;
    std::optional<double> goal_;    ///< the synchronous solver's error
    std::optional<double> needed_;  ///< iterations of the synchronous solver for it
    bool has_goal_ = false;
    std::map<std::pair<std::string, int>, std::optional<double>> known_;  ///< [settings, devices]
};

}  // namespace weft
