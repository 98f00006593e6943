#pragma once

#include <vector>

#include "apps/weft/run/run_options.h"

namespace weft {

class Progress;

/// xyz of all vertices in scene order at the end of each frame, one behind the other.
using Trajectory = std::vector<float>;

struct TimedRun {
    Trajectory trajectory;
    double time = 0.0;  ///< [s]
};

RunOptions with_steps(RunOptions run, int substeps, int iterations);

/// All frames of the scene, whatever comes of them. progress: of its frames, if not null. Throws
/// UserError, RunError.
TimedRun run_scene(const RunOptions& run, Progress* progress = nullptr);

/// RMS distance of vertices over the last numbers / 3 of all places [m].
double distance(const Trajectory& a, const Trajectory& b, std::size_t numbers);
double distance(const Trajectory& a, const Trajectory& b);

}  // namespace weft
