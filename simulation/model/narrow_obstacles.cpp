#include "simulation/model/narrow_obstacles.h"

#include <algorithm>

#include "kernels/obstacles/narrow.h"
#include "simulation/families/convert.h"

namespace weft {

namespace {

/// As a part of the longest edge, half of an obstacle's width that is narrow. A right-angled
/// triangle has room for what is narrower than its longest edge; cloth may be stretched by a third
/// until that is more than this.
constexpr double kNarrow = 2.0 / 3.0;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What is held altogether is not kept out of anything.
MovingSurface without_held(MovingSurface surface) {
    std::erase_if(surface.triangles, [&](const std::array<int, 3>& t) {
        return std::ranges::all_of(t, [&](int v) { return surface.positions[at(v)].w == 0.0f; });
    });
    return surface;
}

double longest_edge(const MovingSurface& surface) {
    double longest = 0.0;
    for (const auto& t : surface.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 from = to_vec3(surface.positions[at(t[k])]);
            const Vec3 to = to_vec3(surface.positions[at(t[(k + 1) % 3])]);
            longest = std::max(longest, length(to - from));
        }
    }
    return longest;
}

int most_at_a_vertex(const MovingSurface& surface) {
    std::vector<int> counts(surface.positions.size());
    for (const auto& t : surface.triangles) {
        for (const int v : t) ++counts[at(v)];
    }
    return counts.empty() ? 0 : *std::ranges::max_element(counts);
}

float4 core_of(const Obstacle& obstacle) {
    std::array<float4, WEFT_OBSTACLE_ROWS> rows{};
    const auto& d = obstacle.dimensions;
    rows[6] = to_float4({d[0], d[1], d[2]}, d[3]);
#define WEFT_TRY_SHAPE(name) \
    if (obstacle.shape == #name) rows[7].w = WEFT_OBSTACLE_##name;
    WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_TRY_SHAPE)
#undef WEFT_TRY_SHAPE
    return kernels::core_of(rows.data());
}

kernels::real3 to_real3(Vec3 v) {
    const float4 p = to_float4(v);
    return kernels::make3(p.x, p.y, p.z);
}

}  // namespace

std::unique_ptr<NarrowObstacles> NarrowObstacles::of(const std::vector<Obstacle>& obstacles,
                                                     const MovingSurface& all) {
    const MovingSurface surface = without_held(all);
    const double longest = longest_edge(surface);
    std::vector<int> numbers;
    int count = 0;
    for (const Obstacle& o : obstacles) {
        numbers.push_back(o.half_width + o.thickness < kNarrow * longest ? count++ : -1);
    }
    if (count == 0) return nullptr;
    return std::unique_ptr<NarrowObstacles>(
        new NarrowObstacles(std::move(numbers), count, surface, longest));
}

NarrowObstacles::NarrowObstacles(std::vector<int> numbers, int count, const MovingSurface& surface,
                                 double longest)
    : numbers_(std::move(numbers)),
      count_(count),
      vertex_count_(static_cast<int>(surface.positions.size())),
      reach_(4.0 * longest),  // edges that are stretched to that are looked at
      slots_(most_at_a_vertex(surface)),
      corners_("obstacles.corners", 3 * at(slots_) * at(vertex_count_)),
      planes_("obstacles.planes", at(count) * at(vertex_count_)),
      depths_("obstacles.depths", at(count) * at(vertex_count_)) {
    fill_corners(surface);
}

void NarrowObstacles::fill_corners(const MovingSurface& surface) {
    std::fill(corners_.data(), corners_.data() + corners_.count(), -1);
    std::vector<int> filled(at(vertex_count_));
    for (const auto& t : surface.triangles) {
        for (const int v : t) {
            const int slot = filled[at(v)]++;
            for (int k = 0; k < 3; ++k) {
                corners_[at((3 * slot + k) * vertex_count_ + v)] = t[at(k)];
            }
        }
    }
}

void NarrowObstacles::add_launches(std::vector<Launch>& launches, const Segments& vertices,
                                   Buffer<float4>& positions, Buffer<float4>& previous,
                                   Buffer<float4>& placements, bool notes) {
    const auto obstacle_count = static_cast<int>(numbers_.size());
    for (int o = 0; o < obstacle_count; ++o) {
        if (number_of(o) < 0) continue;
        launches.push_back(launch(kernels::find_obstacle_planes, vertices, positions, previous,
                                  corners_, placements, planes_, depths_, notes ? 1 : 0,
                                  vertex_count_, slots_, static_cast<float>(reach_), obstacle_count,
                                  o, number_of(o), kInstance));
    }
}

void NarrowObstacles::add_meeting_launches(std::vector<Launch>& launches, const Segments& vertices,
                                           Buffer<float4>& positions, Buffer<float4>& previous,
                                           Buffer<float4>& placements, Buffer<float4>& meetings,
                                           float beyond) {
    const auto obstacle_count = static_cast<int>(numbers_.size());
    for (int o = 0; o < obstacle_count; ++o) {
        if (number_of(o) < 0) continue;
        launches.push_back(launch(kernels::find_obstacle_meetings, vertices, positions, previous,
                                  corners_, placements, meetings, vertex_count_, slots_,
                                  static_cast<float>(reach_), beyond, obstacle_count, o,
                                  kInstance));
    }
}

void NarrowObstacles::clear_meetings(Buffer<float4>& meetings) {
    std::fill(meetings.data(), meetings.data() + meetings.count(),
              float4{0, 0, 0, WEFT_NO_MEETING});
}

double NarrowObstacles::depth(const Obstacle& obstacle, const Frame& frame, int vertex,
                              std::span<const float4> positions) const {
    const float4 core = core_of(obstacle);
    const auto local = [&](int v) { return to_real3(frame.to_local(to_vec3(positions[at(v)]))); };
    const kernels::real3 own = local(vertex);
    const kernels::real3 away = kernels::subtract(own, kernels::nearest_of_core(own, core));
    float nearest = core.w + static_cast<float>(reach_);
    if (kernels::length3(away) > nearest) return -reach_;
    for (int slot = 0; slot < slots_; ++slot) {
        std::array<int, 3> t{};
        for (int k = 0; k < 3; ++k) {
            t[at(k)] = corners_[at((3 * slot + k) * vertex_count_ + vertex)];
        }
        if (t[0] < 0) break;
        const kernels::core_meeting m =
            kernels::meet_core({local(t[0]), local(t[1]), local(t[2])}, core);
        const float weight = t[0] == vertex   ? m.weights.x
                             : t[1] == vertex ? m.weights.y
                                              : m.weights.z;
        if (weight > WEFT_HAS_PART) nearest = std::min(nearest, m.distance);
    }
    return static_cast<double>(core.w - nearest);
}

}  // namespace weft
