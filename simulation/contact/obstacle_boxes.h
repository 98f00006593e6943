#pragma once

#include <vector>

#include "simulation/contact/interval_box.h"
#include "simulation/scene/scene.h"

namespace weft {

/// Where a frame's convex obstacles are, as boxes around what they keep free: of contact's groups
/// of bodies none moves on past one (common_motion.h).
class ObstacleBoxes {
public:
    /// Of the frame that begins at `time` and has substeps of h [s].
    void place(const std::vector<Obstacle>& obstacles, double time, double h, int substeps);

    int count() const { return static_cast<int>(ways_.size()); }
    /// All that the obstacle takes in a substep.
    const IntervalBox& box(int substep, int obstacle) const {
        return boxes_[static_cast<std::size_t>(substep * count() + obstacle)];
    }
    /// All that it takes in the frame.
    IntervalBox box(int obstacle) const;
    /// The farthest that a point of it goes in a substep [m].
    double way(int obstacle) const { return ways_[static_cast<std::size_t>(obstacle)]; }

private:
    std::vector<IntervalBox> boxes_;  ///< [substeps][obstacles]
    std::vector<double> ways_;        ///< [obstacles]
};

}  // namespace weft
