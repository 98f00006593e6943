#include "simulation/contact/obstacle_boxes.h"

#include <cmath>

namespace weft {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A plane has all below it, for which there is a box where it lies along the axes.
IntervalBox below_plane(const Frame& frame) {
    constexpr double kAlong = 1e-9;
    const Vec3 up{frame.axes.rows[0].y, frame.axes.rows[1].y, frame.axes.rows[2].y};
    const Vec3 o = frame.origin;
    IntervalBox box{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    if (std::abs(up.x) > 1.0 - kAlong) (up.x > 0.0 ? box.high.x : box.low.x) = o.x;
    if (std::abs(up.y) > 1.0 - kAlong) (up.y > 0.0 ? box.high.y : box.low.y) = o.y;
    if (std::abs(up.z) > 1.0 - kAlong) (up.z > 0.0 ? box.high.z : box.low.z) = o.z;
    return box;
}

IntervalBox box_at(const Obstacle& obstacle, const Frame& frame) {
    if (std::isinf(obstacle.half_width)) return below_plane(frame);
    IntervalBox box;
    for (int corner = 0; corner < 8; ++corner) {
        const auto side = [&](int bit, double half) { return corner & bit ? half : -half; };
        const Vec3 half = obstacle.half_size;
        box.include(frame.to_world({side(1, half.x), side(2, half.y), side(4, half.z)}));
    }
    return box;
}

}  // namespace

void ObstacleBoxes::place(const std::vector<Obstacle>& obstacles, double time, double h,
                          int substeps) {
    boxes_.clear();
    ways_.assign(obstacles.size(), 0.0);
    for (int substep = 0; substep < substeps; ++substep) {
        for (std::size_t o = 0; o < obstacles.size(); ++o) {
            const Frame before = obstacles[o].frame_at(time + substep * h);
            const Frame now = obstacles[o].frame_at(time + (substep + 1) * h);
            const double way = farthest_move(before, now, obstacles[o].half_size);
            IntervalBox box = box_at(obstacles[o], before);
            box.include(box_at(obstacles[o], now));
            boxes_.push_back(box.grown(obstacles[o].thickness + 0.5 * way));
            ways_[o] = std::max(ways_[o], way);
        }
    }
}

IntervalBox ObstacleBoxes::box(int obstacle) const {
    IntervalBox all;
    for (std::size_t b = static_cast<std::size_t>(obstacle); b < boxes_.size(); b += ways_.size()) {
        all.include(boxes_[b]);
    }
    return all;
}

}  // namespace weft
