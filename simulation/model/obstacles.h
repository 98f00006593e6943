#pragma once

#include <vector>

#include "runtime/launch.h"
#include "simulation/scene/scene.h"

namespace weft {

/// What obstacles push besides positions (kernels/obstacles/contact.h).
struct PushedTargets {
    Buffer<float4>* targets = nullptr;  ///< [vertices] x~ and grip; null: they are not told
    bool are_last = false;              ///< behind the step of bodies as wholes; x~ stays
};

/// The obstacles of a scene on the devices: where each is in every substep of a frame.
class Obstacles {
public:
    Obstacles(const std::vector<Obstacle>& obstacles, int substeps);

    /// Fills in the frame that begins at `time` and has substeps of h [s].
    void place(double time, double h);
    Buffer<float4>& placements() { return placements_; }
    const Buffer<float4>& placements() const { return placements_; }

    int count() const { return static_cast<int>(obstacles_.size()); }
    bool have_friction() const;
    /// One launch per obstacle that pushes all vertices out of it.
    /// vertices: one segment per strip
    void add_launches(std::vector<Launch>& launches, const Segments& vertices,
                      Buffer<float4>& positions, Buffer<float4>& previous,
                      const PushedTargets& pushed);

private:
    std::vector<Obstacle> obstacles_;
    int substeps_;
    Buffer<float4> placements_;  ///< [substep][obstacle][WEFT_OBSTACLE_ROWS]
};

/// The signed distance [m] of a point of the world from an obstacle's surface at `time` [s].
double distance_to(const Obstacle& obstacle, Vec3 point, double time);
/// The same for a point of its own frame.
double distance_to_local(const Obstacle& obstacle, Vec3 local);
/// Outwards from the surface, of length 1, in its own frame.
Vec3 normal_at_local(const Obstacle& obstacle, Vec3 local);

}  // namespace weft
