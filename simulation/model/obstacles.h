#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/launch.h"
#include "simulation/model/narrow_obstacles.h"
#include "simulation/scene/scene.h"

namespace weft {

/// What obstacles push besides positions (kernels/obstacles/contact.h).
struct PushedTargets {
    Buffer<float4>* targets = nullptr;   ///< [vertices] x~ and grip; null: they are not told
    Buffer<float4>* pressing = nullptr;  ///< [vertices] what presses; null: nobody asks
    bool are_last = false;               ///< behind the step of bodies as wholes; x~ stays
    bool have_planes = false;            ///< of narrow obstacles: they are found by now
};

/// The obstacles of a scene on the devices: where each is in every substep of a frame.
class Obstacles {
public:
    /// narrow: those that triangles are kept off, too; null: none
    Obstacles(const std::vector<Obstacle>& obstacles, int substeps,
              std::unique_ptr<NarrowObstacles> narrow = nullptr);

    /// Fills in the frame that begins at `time` and has substeps of h [s].
    void place(double time, double h);
    Buffer<float4>& placements() { return placements_; }
    const Buffer<float4>& placements() const { return placements_; }

    int count() const { return static_cast<int>(obstacles_.size()); }
    bool have_friction() const;
    /// Null: vertices are all that is kept out of any of them.
    NarrowObstacles* narrow() { return narrow_.get(); }
    const NarrowObstacles* narrow() const { return narrow_.get(); }
    /// One launch per obstacle that pushes all vertices out of it.
    /// vertices: one segment per strip
    void add_launches(std::vector<Launch>& launches, const Segments& vertices,
                      Buffer<float4>& positions, Buffer<float4>& previous,
                      const PushedTargets& pushed);

    /// [m] farther than that from where an obstacle has its local origin nothing touches it.
    double reach(std::size_t obstacle) const;
    /// Whether one of them, which is at `frame`, has come up to a vertex, or to a triangle around
    /// it that is kept off.
    /// positions  [vertices] new order; touch: what counts as up to it [m]
    bool touches(std::size_t obstacle, const Frame& frame, int vertex,
                 std::span<const float4> positions, double touch) const;
    /// NarrowObstacles::depth(); infinitely far from one that is not narrow.
    double depth_of_triangles(std::size_t obstacle, const Frame& frame, int vertex,
                              std::span<const float4> positions) const;

private:
    bool is_narrow(std::size_t obstacle) const;
    /// Of obstacles that are not narrow the kernel reads no planes, whatever it is given.
    Launch launch_push(int obstacle, const Segments& vertices, Buffer<float4>& positions,
                       Buffer<float4>& previous, const PushedTargets& pushed);

    std::vector<Obstacle> obstacles_;
    std::unique_ptr<NarrowObstacles> narrow_;
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
