#include "simulation/model/moving_pins.h"

#include <algorithm>

#include "kernels/motion.h"
#include "simulation/families/convert.h"

namespace weft {

MovingPins::MovingPins(std::vector<Group> groups, const Strips& strips, int substeps)
    : groups_(std::move(groups)),
      substeps_(substeps),
      motions_("pins.motions", static_cast<std::size_t>(substeps) * groups_.size() * 3) {
    for (const Group& group : groups_) {
        const std::size_t count = group.vertices.size();
        auto table = std::unique_ptr<Table>(new Table{{"pins.vertices", count},
                                                      {"pins.rest", count},
                                                      {"pins.segments", strips.begin.size()},
                                                      {}});
        for (std::size_t i = 0; i < count; ++i) {
            table->vertices[i] = group.vertices[i];
            table->rest[i] = to_float4(group.rest[i]);
        }
        for (std::size_t s = 0; s < strips.begin.size(); ++s) {
            const auto first =
                std::lower_bound(group.vertices.begin(), group.vertices.end(), strips.begin[s]);
            table->segment_begin[s] = static_cast<int>(first - group.vertices.begin());
        }
        table->segments = {&table->segment_begin, 0, 1, strips.count()};
        tables_.push_back(std::move(table));
    }
}

void MovingPins::place(double time, double h) {
    float4* rows = motions_.data();
    for (int substep = 0; substep < substeps_; ++substep) {
        for (const Group& group : groups_) {
            const Frame map = group.motion.displacement(time + (substep + 1) * h);
            const double t[3] = {map.origin.x, map.origin.y, map.origin.z};
            for (std::size_t k = 0; k < 3; ++k) *rows++ = to_float4(map.axes.rows[k], t[k]);
        }
    }
}

double MovingPins::farthest_move(double time, double h) const {
    double most = 0.0;
    for (int substep = 0; substep < substeps_; ++substep) {
        for (const Group& group : groups_) {
            const Frame before = group.motion.displacement(time + substep * h);
            const Frame now = group.motion.displacement(time + (substep + 1) * h);
            for (const Vec3& p : group.rest) {
                most = std::max(most, length(now.to_world(p) - before.to_world(p)));
            }
        }
    }
    return most;
}

std::optional<Vec3> MovingPins::common_velocity(double time, double h, int substeps) const {
    constexpr double kSame = 1e-6;  // of both, in single precision
    const auto place = [&](const Group& group, int substep) {
        return group.motion.displacement(time + substep * h);
    };
    const Vec3 first =
        (1.0 / h) * (place(groups_.front(), 1).origin - place(groups_.front(), 0).origin);
    for (const Group& group : groups_) {
        const Frame start = place(group, 0);
        for (int substep = 1; substep <= substeps; ++substep) {
            const Frame now = place(group, substep);
            const Vec3 expected = (substep * h) * first;
            const bool is_same =
                now.axes == start.axes &&
                length(now.origin - start.origin - expected) <= kSame * length(expected);
            if (!is_same) return std::nullopt;
        }
    }
    return first;
}

std::size_t MovingPins::count() const {
    std::size_t sum = 0;
    for (const Group& group : groups_) sum += group.vertices.size();
    return sum;
}

void MovingPins::place_at(double time, std::span<Vec3> positions) const {
    for (const Group& group : groups_) {
        const Frame map = group.motion.displacement(time);
        for (std::size_t i = 0; i < group.vertices.size(); ++i) {
            positions[static_cast<std::size_t>(group.vertices[i])] = map.to_world(group.rest[i]);
        }
    }
}

void MovingPins::add_launches(std::vector<Launch>& launches, Buffer<float4>& positions) {
    const int count = static_cast<int>(groups_.size());
    for (int g = 0; g < count; ++g) {
        Table& table = *tables_[static_cast<std::size_t>(g)];
        launches.push_back(launch(kernels::move_pins, table.segments, positions, table.vertices,
                                  table.rest, motions_, count, g, kInstance));
    }
}

}  // namespace weft
