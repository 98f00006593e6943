#pragma once

#include <vector>

#include "runtime/launch.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The obstacles of a scene on the devices: where each is in every substep of a frame.
class Obstacles {
public:
    Obstacles(const std::vector<Obstacle>& obstacles, int substeps);

    /// Fills in the frame that begins at `time` and has substeps of h [s].
    void place(double time, double h);
    Buffer<float4>& placements() { return placements_; }

    bool have_friction() const;
    /// One launch per obstacle that pushes all vertices out of it.
    /// vertices: one segment per strip
    void add_launches(std::vector<Launch>& launches, const Segments& vertices,
                      Buffer<float4>& positions, Buffer<float4>& previous);

private:
    std::vector<Obstacle> obstacles_;
    int substeps_;
    Buffer<float4> placements_;  ///< [substep][obstacle][WEFT_OBSTACLE_ROWS]
};

}  // namespace weft
