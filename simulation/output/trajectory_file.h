#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft {

/// A whole run with so many substeps per frame and iterations per substep.
struct TrajectoryPoint {
    int substeps = 0;
    int iterations = 0;
    double time = 0.0;           ///< [s] that all frames took
    double distance = 0.0;       ///< [m] from the reference: RMS over vertices and frames
    double last_distance = 0.0;  ///< [m] RMS over vertices, at the end
    bool on_front = false;       ///< no other run of the study is both as fast and as near
};

/// A run that did not come to its end, or did not begin.
struct UnfinishedRun {
    int substeps = 0;
    int iterations = 0;
    std::string why;
};

/// One solver on one device list by one kind of plan.
struct TrajectoryCurve {
    std::string solver, devices, plan;
    std::vector<TrajectoryPoint> points;
    std::vector<UnfinishedRun> unfinished;
};

struct TrajectoryStudy {
    std::string scene;
    int frames = 0;
    int vertices = 0;
    double frame_time = 0.0;   ///< [s]
    std::string reference_by;  ///< what made the reference, in words
    int reference_substeps = 0;
    /// [m] RMS between the reference and itself with half as many substeps: how far it is sure.
    double doubt = 0.0;
    std::vector<TrajectoryCurve> curves;
};

/// trajectory.h5: the reference as attributes, and a group per curve. Throws RunError.
void write_trajectory_file(const std::filesystem::path& path, const TrajectoryStudy& study);

}  // namespace weft
