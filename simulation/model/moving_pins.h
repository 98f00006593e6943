#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/launch.h"
#include "runtime/owned.h"
#include "simulation/scene/motion.h"
#include "simulation/topology/strips.h"

namespace weft {

/// Pinned vertices that are carried along by a motion. Pins that stay need nothing of this.
class MovingPins {
public:
    struct Group {
        std::vector<int> vertices;  ///< new vertices, ascending
        std::vector<Vec3> rest;     ///< where they are at time 0
        Motion motion;
        /// Instead of the motion: [frames][vertices] where they are every frame_time [s].
        std::vector<std::vector<Vec3>> frames{};
        double frame_time = 0.0;
    };
    MovingPins(std::vector<Group> groups, const Strips& strips, int substeps);

    /// Fills in the frame that begins at `time` and has substeps of h [s].
    void place(double time, double h);
    /// The velocity of all pins, if they all have the same in all `substeps` of h [s] from `time`
    /// on [m/s]; not known of those that have frames.
    std::optional<Vec3> common_velocity(double time, double h, int substeps) const;
    /// The one that a vertex is led by; none: it stays, or is not held.
    std::optional<std::size_t> group_of(int vertex) const;
    /// Whether distances within a group stay as they are.
    bool is_rigid(std::size_t group) const { return groups_[group].frames.empty(); }
    /// How many vertices move.
    std::size_t count() const;
    /// Writes where the pins are at `time` into their places of `positions` (new order).
    void place_at(double time, std::span<Vec3> positions) const;
    /// Those that place() writes.
    void add_placed(std::vector<BufferStorage*>& buffers);
    void add_launches(std::vector<Launch>& launches, Buffer<float4>& positions);

private:
    struct Table {
        Buffer<int> vertices;
        Buffer<float4> rest;
        Buffer<int> segment_begin;  ///< [strips + 1]
        Segments segments;
        /// [2 * vertices] where they are at the frame's start and end; null: no frames
        Owned<Buffer<float4>> ends{};
    };
    void place_ends(const Group& group, Table& table, double time, double h) const;
    std::vector<Group> groups_;
    std::vector<Owned<Table>> tables_;  ///< [group]
    int substeps_;
    Buffer<float4> motions_;  ///< [substep][group][3 rows]
};

}  // namespace weft
