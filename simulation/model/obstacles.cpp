#include "simulation/model/obstacles.h"

#include <algorithm>
#include <stdexcept>

#include "kernels/obstacles/shapes.h"
#include "simulation/model/convert.h"

namespace weft {

namespace {

struct ContactArguments {
    const Segments& vertices;
    Buffer<float4>& positions;
    Buffer<float4>& previous;
    Buffer<float4>& placements;
    int obstacle_count;
    int obstacle;
    bool friction;
};

template <class Push, class Rub>
Launch contact(Push push, Rub rub, const ContactArguments& a) {
    if (!a.friction) {
        return launch(push, a.vertices, a.positions, a.placements, a.obstacle_count, a.obstacle,
                      kInstance);
    }
    return launch(rub, a.vertices, a.positions, a.previous, a.placements, a.obstacle_count,
                  a.obstacle, kInstance);
}

/// The kernels of each shape of obstacle_shapes.h.
Launch contact_with(const std::string& shape, const ContactArguments& a) {
    using namespace kernels;
#define WEFT_TRY_SHAPE(name) \
    if (shape == #name) return contact(push_out_of_##name, rub_on_##name, a);
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    throw std::logic_error("obstacle shape '" + shape + "' has no kernel");
}

void write_rows(float4* rows, const Mat3& rotation, Vec3 translation) {
    const double t[3] = {translation.x, translation.y, translation.z};
    for (std::size_t k = 0; k < 3; ++k) rows[k] = to_float4(rotation.rows[k], t[k]);
}

void write_placement(float4* rows, const Obstacle& obstacle, double start, double end) {
    const Frame now = obstacle.frame_at(end);
    const Frame before = obstacle.frame_at(start);
    const Mat3 to_local = transposed(now.axes);
    write_rows(rows, to_local, -(to_local * now.origin));
    write_rows(rows + 3, before.axes, before.origin);
    const auto& d = obstacle.dimensions;
    rows[6] = to_float4({d[0], d[1], d[2]}, d[3]);
    rows[7] = to_float4({obstacle.thickness, obstacle.friction.value_or(0.0), 0.0});
}

}  // namespace

Obstacles::Obstacles(const std::vector<Obstacle>& obstacles, int substeps)
    : obstacles_(obstacles),
      substeps_(substeps),
      placements_("obstacles",
                  static_cast<std::size_t>(substeps) * obstacles.size() * WEFT_OBSTACLE_ROWS) {}

void Obstacles::place(double time, double h) {
    float4* rows = placements_.data();
    for (int substep = 0; substep < substeps_; ++substep) {
        for (const Obstacle& obstacle : obstacles_) {
            write_placement(rows, obstacle, time + substep * h, time + (substep + 1) * h);
            rows += WEFT_OBSTACLE_ROWS;
        }
    }
}

bool Obstacles::have_friction() const {
    return std::any_of(obstacles_.begin(), obstacles_.end(),
                       [](const Obstacle& o) { return o.friction.has_value(); });
}

void Obstacles::add_launches(std::vector<Launch>& launches, const Segments& vertices,
                             Buffer<float4>& positions, Buffer<float4>& previous) {
    const int count = static_cast<int>(obstacles_.size());
    for (int i = 0; i < count; ++i) {
        const Obstacle& obstacle = obstacles_[static_cast<std::size_t>(i)];
        launches.push_back(contact_with(obstacle.shape, {vertices, positions, previous, placements_,
                                                         count, i, obstacle.friction.has_value()}));
    }
}

}  // namespace weft
