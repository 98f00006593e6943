#include "simulation/model/obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/obstacles/shapes.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

/// Calls launch_shape with the kernel of the obstacle's shape (obstacle_shapes.h).
template <class LaunchShape>
Launch launch_for(const Obstacle& obstacle, LaunchShape launch_shape) {
    using namespace kernels;
#define WEFT_TRY_SHAPE(name) \
    if (obstacle.shape == #name) return launch_shape(push_out_of_##name);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    throw std::logic_error("obstacle shape '" + obstacle.shape + "' has no kernel");
}

int told_of(const PushedTargets& pushed) {
    if (pushed.targets == nullptr) return WEFT_PUSH_ALONE;
    if (pushed.are_last) return WEFT_PUSH_LAST;
    return pushed.pressing == nullptr ? WEFT_PUSH_LEADS : WEFT_PUSH_PRESSES;
}

void write_rows(float4* rows, const Mat3& rotation, Vec3 translation) {
    const double t[3] = {translation.x, translation.y, translation.z};
    for (std::size_t k = 0; k < 3; ++k) rows[k] = to_float4(rotation.rows[k], t[k]);
}

/// An obstacle at the start and at the end of a substep.
struct Stay {
    Frame before, now;
    double move = 0.0;  ///< [m] of its fastest point
};

std::vector<Stay> stays_of(const std::vector<Obstacle>& obstacles, double start, double end) {
    std::vector<Stay> stays;
    for (const Obstacle& o : obstacles) {
        const Stay stay{o.frame_at(start), o.frame_at(end)};
        stays.push_back(stay);
        stays.back().move = farthest_move(stay.before, stay.now, o.half_size);
    }
    return stays;
}

/// Its number in the kernels' rows.
float number_of(const std::string& shape) {
#define WEFT_TRY_SHAPE(name) \
    if (shape == #name) return WEFT_OBSTACLE_##name;
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    throw std::logic_error("obstacle shape '" + shape + "' has no number");
}

/// From which way of a vertex on, squared [m^2], it may be past the middle of the obstacle, where
/// it would be pushed out on the wrong side, or not at all. Of a plane it never is.
double swept_from(const Obstacle& obstacle, const Stay& stay) {
    const double way = 0.5 * obstacle.half_width + obstacle.thickness - stay.move;
    constexpr double kNever = std::numeric_limits<float>::max();
    return way > 0.0 ? std::min(way * way, kNever) : 0.0;
}

void write_placement(float4* rows, const Obstacle& obstacle, const Stay& stay) {
    const Mat3 to_local = transposed(stay.now.axes);
    write_rows(rows, to_local, -(to_local * stay.now.origin));
    write_rows(rows + 3, stay.before.axes, stay.before.origin);
    const auto& d = obstacle.dimensions;
    rows[6] = to_float4({d[0], d[1], d[2]}, d[3]);
    rows[7] =
        to_float4({obstacle.thickness, obstacle.friction.value_or(0.0), swept_from(obstacle, stay)},
                  static_cast<double>(number_of(obstacle.shape)));
}

kernels::nearness near_obstacle(const Obstacle& obstacle, Vec3 local) {
    const auto& d = obstacle.dimensions;
    const float4 dimensions = to_float4({d[0], d[1], d[2]}, d[3]);
    const float4 p = to_float4(local);
    const kernels::real3 point = kernels::make3(p.x, p.y, p.z);
#define WEFT_TRY_SHAPE(name) \
    if (obstacle.shape == #name) return kernels::near_##name(point, dimensions);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    throw std::logic_error("obstacle shape '" + obstacle.shape + "' has no distance");
}

}  // namespace

Obstacles::Obstacles(const std::vector<Obstacle>& obstacles, int substeps,
                     std::unique_ptr<NarrowObstacles> narrow)
    : obstacles_(obstacles),
      narrow_(std::move(narrow)),
      substeps_(substeps),
      placements_("obstacles",
                  static_cast<std::size_t>(substeps) * obstacles.size() * WEFT_OBSTACLE_ROWS) {}

void Obstacles::place(double time, double h) {
    float4* rows = placements_.data();
    for (int substep = 0; substep < substeps_; ++substep) {
        const auto stays = stays_of(obstacles_, time + substep * h, time + (substep + 1) * h);
        for (std::size_t i = 0; i < stays.size(); ++i) {
            write_placement(rows, obstacles_[i], stays[i]);
            rows += WEFT_OBSTACLE_ROWS;
        }
    }
}

bool Obstacles::have_friction() const {
    return std::any_of(obstacles_.begin(), obstacles_.end(),
                       [](const Obstacle& o) { return o.friction.has_value(); });
}

double distance_to(const Obstacle& obstacle, Vec3 point, double time) {
    return distance_to_local(obstacle, obstacle.frame_at(time).to_local(point));
}

double distance_to_local(const Obstacle& obstacle, Vec3 local) {
    return static_cast<double>(near_obstacle(obstacle, local).distance);
}

Vec3 normal_at_local(const Obstacle& obstacle, Vec3 local) {
    const kernels::real3 normal = near_obstacle(obstacle, local).normal;
    return {static_cast<double>(normal.x), static_cast<double>(normal.y),
            static_cast<double>(normal.z)};
}

void Obstacles::add_launches(std::vector<Launch>& launches, const Segments& vertices,
                             Buffer<float4>& positions, Buffer<float4>& previous,
                             const PushedTargets& pushed) {
    for (int i = 0; i < count(); ++i) {
        launches.push_back(launch_push(i, vertices, positions, previous, pushed));
    }
}

Launch Obstacles::launch_push(int obstacle, const Segments& vertices, Buffer<float4>& positions,
                              Buffer<float4>& previous, const PushedTargets& pushed) {
    Buffer<float4>& targets = pushed.targets ? *pushed.targets : positions;
    Buffer<float4>& pressing = pushed.pressing ? *pushed.pressing : targets;
    const bool have_planes = narrow_ && pushed.have_planes;
    Buffer<float4>& planes = have_planes ? narrow_->planes() : previous;
    const int vertex_count = have_planes ? narrow_->vertex_count() : 0;
    const int narrow = have_planes ? narrow_->number_of(obstacle) : -1;
    return launch_for(obstacles_[static_cast<std::size_t>(obstacle)], [&](auto kernel) {
        return launch(kernel, vertices, positions, previous, targets, pressing, placements_, planes,
                      told_of(pushed), vertex_count, narrow, count(), obstacle, kInstance);
    });
}

bool Obstacles::is_narrow(std::size_t obstacle) const {
    return narrow_ && narrow_->number_of(static_cast<int>(obstacle)) >= 0;
}

double Obstacles::reach(std::size_t obstacle) const {
    const Obstacle& one = obstacles_[obstacle];
    if (one.half_size == Vec3{}) return std::numeric_limits<double>::infinity();
    return length(one.half_size) + one.thickness + (narrow_ ? narrow_->reach() : 0.0);
}

bool Obstacles::touches(std::size_t obstacle, const Frame& frame, int vertex,
                        std::span<const float4> positions, double touch) const {
    const Obstacle& one = obstacles_[obstacle];
    const double near = one.thickness + touch;
    const Vec3 local = frame.to_local(to_vec3(positions[static_cast<std::size_t>(vertex)]));
    if (distance_to_local(one, local) <= near) return true;
    if (!is_narrow(obstacle)) return false;
    // What comes down on it is pushed a little too far by some of its triangles.
    return depth_of_triangles(obstacle, frame, vertex, positions) >= -near - 0.1 * one.half_width;
}

double Obstacles::depth_of_triangles(std::size_t obstacle, const Frame& frame, int vertex,
                                     std::span<const float4> positions) const {
    if (!is_narrow(obstacle)) return -std::numeric_limits<double>::infinity();
    return narrow_->depth(obstacles_[obstacle], frame, vertex, positions);
}

}  // namespace weft
