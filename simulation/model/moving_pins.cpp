#include "simulation/model/moving_pins.h"

#include <algorithm>

#include "kernels/motion.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

/// Where a pin is at a time [s].
Vec3 place_of(const MovingPins::Group& group, std::size_t pin, double time, const Frame& map) {
    if (group.frames.empty()) return map.to_world(group.rest[pin]);
    const double last = static_cast<double>(group.frames.size() - 1);
    const double at = std::clamp(time / group.frame_time, 0.0, last);
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, group.frames.size() - 1);
    const Vec3 from = group.frames[before][pin];
    return from + (at - static_cast<double>(before)) * (group.frames[after][pin] - from);
}

}  // namespace

MovingPins::MovingPins(std::vector<Group> groups, const Strips& strips, int substeps)
    : groups_(std::move(groups)),
      substeps_(substeps),
      motions_("pins.motions", static_cast<std::size_t>(substeps) * groups_.size() * 3) {
    for (const Group& group : groups_) {
        const std::size_t count = group.vertices.size();
        auto table = std::unique_ptr<Table>(new Table{{"pins.vertices", count},
                                                      {"pins.rest", count},
                                                      {"pins.segments", strips.begin.size()},
                                                      {},
                                                      nullptr});
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
        if (!group.frames.empty()) {
            table->ends = std::make_unique<Buffer<float4>>("pins.ends", 2 * count);
        }
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
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (tables_[g]->ends) place_ends(groups_[g], *tables_[g], time, h);
    }
}

/// Nearly always a frame's ends are those of one step between two files.
void MovingPins::place_ends(const Group& group, Table& table, double time, double h) const {
    const std::size_t count = group.vertices.size();
    for (std::size_t i = 0; i < count; ++i) {
        (*table.ends)[i] = to_float4(place_of(group, i, time, {}));
        (*table.ends)[count + i] = to_float4(place_of(group, i, time + substeps_ * h, {}));
    }
}

void MovingPins::add_placed(std::vector<BufferStorage*>& buffers) {
    buffers.push_back(&motions_);
    for (auto& table : tables_) {
        if (table->ends) buffers.push_back(table->ends.get());
    }
}

std::optional<Vec3> MovingPins::common_velocity(double time, double h, int substeps) const {
    const auto follows = [](const Group& group) { return !group.frames.empty(); };
    if (std::ranges::any_of(groups_, follows)) return std::nullopt;
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

std::optional<std::size_t> MovingPins::group_of(int vertex) const {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (std::ranges::binary_search(groups_[g].vertices, vertex)) return g;
    }
    return std::nullopt;
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
            positions[static_cast<std::size_t>(group.vertices[i])] = place_of(group, i, time, map);
        }
    }
}

void MovingPins::add_launches(std::vector<Launch>& launches, Buffer<float4>& positions) {
    const int count = static_cast<int>(groups_.size());
    for (int g = 0; g < count; ++g) {
        Table& table = *tables_[static_cast<std::size_t>(g)];
        if (table.ends) {
            launches.push_back(launch(kernels::move_between, table.segments, positions,
                                      table.vertices, *table.ends,
                                      static_cast<int>(table.vertices.count()), substeps_,
                                      1.0f / static_cast<float>(substeps_), kInstance));
            continue;
        }
        launches.push_back(launch(kernels::move_pins, table.segments, positions, table.vertices,
                                  table.rest, motions_, count, g, kInstance));
    }
}

}  // namespace weft
