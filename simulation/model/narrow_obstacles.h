#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "runtime/launch.h"
#include "simulation/scene/scene.h"

namespace weft {

/// The triangles of cloths and solids' surfaces, in new vertices.
struct MovingSurface {
    std::span<const float4> positions;  ///< [vertices] at time 0: xyz [m], w = 1/mass [1/kg]
    std::vector<std::array<int, 3>> triangles;
};

/// The obstacles of a scene that are narrower than its triangles: these, too, are kept out of them,
/// by planes that each vertex gets behind every iteration (kernels/obstacles/narrow.h).
class NarrowObstacles {
public:
    /// Null: all are so wide that to keep vertices out is enough.
    static std::unique_ptr<NarrowObstacles> of(const std::vector<Obstacle>& obstacles,
                                               const MovingSurface& surface);

    /// One launch per narrow obstacle, that finds the planes.
    /// vertices: one segment per strip; placements: of all obstacles; notes: depths, too, behind a
    /// substep's last push; others as in the kernel
    void add_launches(std::vector<Launch>& launches, const Segments& vertices,
                      Buffer<float4>& positions, Buffer<float4>& previous,
                      Buffer<float4>& placements, bool notes);

    /// One launch per narrow obstacle, that finds the triangle around each vertex which is nearest
    /// to it, where it is nearer than `beyond` [m].
    /// meetings: [2 * obstacles * vertex_count()] column-major, as clear_meetings() leaves them,
    /// once
    void add_meeting_launches(std::vector<Launch>& launches, const Segments& vertices,
                              Buffer<float4>& positions, Buffer<float4>& previous,
                              Buffer<float4>& placements, Buffer<float4>& meetings, float beyond);
    /// Fills them: of obstacles that are not narrow they stay like that.
    static void clear_meetings(Buffer<float4>& meetings);

    /// Its number among narrow ones; -1: it is none.
    int number_of(int obstacle) const { return numbers_[static_cast<std::size_t>(obstacle)]; }
    int count() const { return count_; }
    /// [m] how far vertices may be from what their triangles meet.
    double reach() const { return reach_; }
    int vertex_count() const { return vertex_count_; }
    /// [vertex_count() * count()] column-major
    Buffer<float4>& planes() { return planes_; }
    /// [vertex_count() * count()] column-major: how deep in each obstacle substeps of the frame
    /// have left the triangles around each vertex [m].
    Buffer<float>& depths() { return depths_; }

    /// How deep a triangle around the vertex is in the obstacle, which is at `frame`, somewhere
    /// where the vertex counts [m]; negative: that far from it, or there is nothing near.
    double depth(const Obstacle& obstacle, const Frame& frame, int vertex,
                 std::span<const float4> positions) const;

private:
    NarrowObstacles(std::vector<int> numbers, int count, const MovingSurface& surface,
                    double longest);
    void fill_corners(const MovingSurface& surface);

    std::vector<int> numbers_;  ///< [obstacles]
    int count_;
    int vertex_count_;
    double reach_;
    int slots_;  ///< the most triangles at a vertex
    Buffer<int> corners_;
    Buffer<float4> planes_;
    Buffer<float> depths_;
};

}  // namespace weft
