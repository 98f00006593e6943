// Every shape has kernels of the same signature, so a new shape is tested without another line
// here.

#include "kernels/contact/resting.h"
#include "kernels/descent/cloth_reactions.h"
#include "kernels/newton/holds.h"
#include "kernels/obstacles/inside.h"
#include "kernels/obstacles/narrow.h"

#include <limits>

#include "tests/kernels/contact_response_parts.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kObstacles = 2;
constexpr int kSubsteps = 3;

#define WEFT_NUMBER(name) WEFT_OBSTACLE_##name,
constexpr float kShapes[] = {WEFT_FOR_EACH_OBSTACLE_SHAPE(WEFT_NUMBER)};
#undef WEFT_NUMBER

/// Obstacle 1 in each substep: a placement that is a rotation (by a Pythagorean triple, so that its
/// entries are nearly exact), and another one a little earlier.
void place(KernelCase& c, Buffer<float4>& obstacles) {
    for (int i = 0; i < kObstacles * kSubsteps; ++i) {
        float4* rows = obstacles.data() + WEFT_OBSTACLE_ROWS * i;
        const float shift = c.flavour == Flavour::kRandom ? 0.05f * static_cast<float>(i) : 0.0f;
        rows[0] = {0.8f, 0.6f, 0.0f, -shift};
        rows[1] = {-0.6f, 0.8f, 0.0f, 0.0f};
        rows[2] = {0.0f, 0.0f, 1.0f, 0.0f};
        rows[3] = {0.8f, -0.6f, 0.0f, shift};
        rows[4] = {0.6f, 0.8f, 0.0f, 0.01f};
        rows[5] = {0.0f, 0.0f, 1.0f, 0.0f};
        if (c.flavour == Flavour::kDegenerate) {
            rows[0] = rows[3] = {1.0f, 0.0f, 0.0f, 0.0f};
            rows[1] = rows[4] = {0.0f, 1.0f, 0.0f, 0.0f};
        }
        rows[6] = {0.5f, 0.25f, 0.5f, 0.0f};
        constexpr float kNever = std::numeric_limits<float>::max();
        const float swept_from[] = {0.0f, 0.25f, kNever};  // all, some, and none
        const int which = c.flavour == Flavour::kRandom ? c.random.integer(0, 2) : 0;
        const float friction = c.random.integer(0, 2) == 0 ? 0.0f : 0.3f;
        const float shape = kShapes[c.random.integer(0, std::size(kShapes) - 1)];
        rows[7] = {0.01f, friction, swept_from[which], shape};
    }
}

Buffer<float4>& add_obstacles(KernelCase& c) {
    auto& obstacles = c.add<float4>("obstacles", kSubsteps * kObstacles * WEFT_OBSTACLE_ROWS);
    place(c, obstacles);
    return obstacles;
}

/// Points near shapes, and where several of their parts are as near.
void scatter(KernelCase& c, Buffer<float4>& points) {
    const float special[] = {0.0f, 0.25f, -0.25f,
                             0.5f, -0.5f, 1.0f};  // centres, faces, edges, corners
    for (float4& x : points.span()) {
        x = c.random.point(0.8f);
        if (c.flavour != Flavour::kDegenerate) continue;
        const auto pick = [&] { return special[c.random.integer(0, 5)]; };
        x = {pick(), pick(), pick(), 0.0f};
    }
}

/// x~, and grips of what has been pushed; others have none.
Buffer<float4>& add_targets(KernelCase& c) {
    auto& targets = c.add<float4>("targets", c.items);
    scatter(c, targets);
    for (float4& target : targets.span()) target.w = std::max(c.random.real(-0.1f, 0.1f), 0.0f);
    return targets;
}

/// Of vertices that have moved, some of them held.
struct Moved {
    Buffer<float4>&positions, &previous;
};

Moved add_moved(KernelCase& c) {
    Moved moved{c.add<float4>("positions", c.items), c.add<float4>("previous", c.items)};
    scatter(c, moved.positions);
    for (std::size_t v = 0; v < moved.positions.count(); ++v) {
        const float4 way = c.random.point(c.flavour == Flavour::kRandom ? 0.9f : 0.0f);
        float4& x = moved.positions[v];
        moved.previous[v] = {x.x + way.x, x.y + way.y, x.z + way.z, 0.0f};
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : 1.0f;
    }
    return moved;
}

Argument whole(int value) {
    Argument argument;
    argument.integer = value;
    return argument;
}

/// Behind the arguments of its own: how many obstacles there are, which one, and the substep.
void finish(KernelCase& c, const kernels::KernelInfo& kernel) {
    Argument substep;
    substep.run_value = RunValue::kOfInstance;
    c.launch.kernel = &kernel;
    c.launch.segments = c.segments;
    c.launch.arguments.insert(c.launch.arguments.end(), {whole(kObstacles), whole(1), substep});
}

/// Planes of two narrow obstacles, through about where the vertices are, and none.
Buffer<float4>& add_planes(KernelCase& c, const Buffer<float4>& positions) {
    auto& planes = c.add<float4>("planes", 2 * c.items);
    for (std::size_t k = 0; k < planes.count(); ++k) {
        const float4& x = positions[k % positions.count()];
        const float beyond = c.random.real(-0.1f, 0.1f);
        planes[k] = {0.6f, 0.0f, -0.8f, 0.6f * x.x - 0.8f * x.z + beyond};
        if (c.random.integer(0, 3) == 0) planes[k] = {0.0f, 0.0f, 0.0f, -3e38f};
    }
    return planes;
}

void push_case(KernelCase& c, Buffer<float4>& obstacles) {
    const Moved moved = add_moved(c);
    auto& targets = add_targets(c);
    auto& pressing = c.add<float4>("pressing", static_cast<int>(targets.count()));
    for (float4& pressed : pressing.span()) pressed = c.random.point(0.01f);
    auto& planes = add_planes(c, moved.positions);
    c.launch.arguments = {{&moved.positions},
                          {&moved.previous},
                          {&targets},
                          {&pressing},
                          {&obstacles},
                          {&planes},
                          whole(c.random.integer(WEFT_PUSH_ALONE, WEFT_PUSH_LAST)),
                          whole(c.items),
                          whole(c.random.integer(-1, 1))};
}

constexpr int kSlots = 4;

/// Triangles between any vertices, up to four at each; some have no area.
Buffer<int>& add_triangles(KernelCase& c) {
    auto& corners = c.add<int>("corners", 3 * kSlots * c.items);
    std::fill(corners.data(), corners.data() + corners.count(), -1);
    for (int v = 0; v < c.items; ++v) {
        for (int slot = 0; slot < c.random.integer(0, kSlots); ++slot) {
            const auto at = [&](int k) {
                return static_cast<std::size_t>((3 * slot + k) * c.items + v);
            };
            for (int k = 0; k < 3; ++k) corners[at(k)] = c.random.integer(0, c.items - 1);
            corners[at(c.random.integer(0, 2))] = v;
        }
    }
    return corners;
}

void planes_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& corners = add_triangles(c);
    auto& planes = c.add<float4>("planes", 2 * c.items);
    auto& depths = c.add<float>("depths", 2 * c.items);
    for (float& depth : depths.span()) depth = std::max(0.0f, c.random.real(-0.2f, 0.2f));
    const int notes = c.random.integer(0, 1);
    const float reach = c.random.integer(0, 1) == 0 ? 0.2f : 5.0f;
    c.launch = launch(kernels::find_obstacle_planes, c.segments, moved.positions, moved.previous,
                      corners, obstacles, planes, depths, notes, c.items, kSlots, reach, kObstacles,
                      1, 1, kInstance);
}

void meetings_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& corners = add_triangles(c);
    auto& meetings = c.add<float4>("meetings", 2 * kObstacles * c.items);
    const float reach = c.random.integer(0, 1) == 0 ? 0.2f : 5.0f;
    c.launch = launch(kernels::find_obstacle_meetings, c.segments, moved.positions, moved.previous,
                      corners, obstacles, meetings, c.items, kSlots, reach,
                      c.random.real(0.0f, 0.5f), kObstacles, 1, kInstance);
}

/// Contact has taken back a quarter of the vertices.
void inside_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& cut = c.add<int>("cut", c.items);
    for (int& one : cut.span()) one = std::max(0, c.random.integer(-5, 2));
    auto& depths = c.add<float>("depths", c.items);
    for (float& depth : depths.span()) depth = std::max(0.0f, c.random.real(-0.2f, 0.2f));
    auto& insides = c.add<int>("insides", c.items);
    for (int& inside : insides.span()) inside = c.random.integer(0, kObstacles - 1);
    c.launch = launch(kernels::find_inside, c.segments, moved.positions, moved.previous, obstacles,
                      cut, depths, insides, kObstacles, kInstance);
}

Buffer<float>& add_flags(KernelCase& c, const char* name, int count) {
    auto& flags = c.add<float>(name, count);
    for (float& flag : flags.span()) flag = static_cast<float>(c.random.integer(0, 1));
    return flags;
}

Buffer<float>& add_flags(KernelCase& c, const char* name) { return add_flags(c, name, c.items); }

/// Of cloth and of others, some of it pushed.
void reactions_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& starts = response::add_points(c, "starts", c.items);
    auto& targets = add_targets(c);
    auto& cloth = c.add<float>("cloth", c.items);
    for (float& one : cloth.span()) one = c.random.integer(0, 5) == 0 ? 0.0f : 1.0f;
    auto& vertices = c.add<int>("vertices", c.items);
    const std::vector<int> order = c.random.permutation(c.items);
    std::copy(order.begin(), order.end(), vertices.data());
    auto& sums = c.add<float>("sums", 9 * c.items);
    for (float& sum : sums.span()) sum = c.random.real(-1e3f, 1e3f);
    auto& planes = add_planes(c, moved.positions);
    const response::Rows rows(c, "contacts", c.items, response::kRoom);
    for (int& count : rows.counts.span()) count = c.random.integer(0, 2) == 0 ? count : 0;
    const auto corner = [&](const char* name) -> Buffer<int>& {
        return response::add_indices(c, name, rows.entries, c.items);
    };
    auto &corner0 = corner("corner0"), &corner1 = corner("corner1"), &corner2 = corner("corner2"),
         &corner3 = corner("corner3");
    c.launch = launch(kernels::lead_cloth, c.segments, moved.positions, moved.previous, starts,
                      targets, cloth, vertices, sums, obstacles, planes, rows.rows, rows.counts,
                      corner0, corner1, corner2, corner3, c.items, 1e4f, c.random.integer(0, 1),
                      c.random.integer(0, 1), c.items, kObstacles, kInstance);
}

/// Of solids and of others, some of it pushed, some cut, where a step has been taken back or not.
void holds_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& starts = response::add_points(c, "starts", c.items);
    auto& targets = add_targets(c);
    auto& sums = c.add<float>("sums", 9 * c.items);
    for (float& sum : sums.span()) sum = c.random.real(-1e3f, 1e3f);
    auto& solid = add_flags(c, "solid");
    auto& cut = response::add_indices(c, "cut", c.items, 3);
    auto& control = add_flags(c, "control", WEFT_CONTROL_SIZE);
    auto& holds = c.add<float4>("holds", c.items);
    c.launch = launch(kernels::find_holds, c.segments, moved.positions, moved.previous, starts,
                      targets, sums, solid, cut, control, obstacles, holds, c.items,
                      c.random.integer(0, 1), kObstacles, 1e4f, kInstance);
}

/// Of what lies there and of others; rows have contacts, and room for few more entries.
void collect_resting_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    constexpr int kRows = 3;
    const Moved moved = add_moved(c);
    auto& seen = response::add_points(c, "seen_targets", c.items);
    auto& starts = response::add_points(c, "starts", c.items);
    auto& kept = response::add_points(c, "kept", c.items);
    auto& borne = add_flags(c, "borne");
    auto& solid = add_flags(c, "solid");
    auto& hardness = c.add<float>("hardness", c.items);
    for (float& k : hardness.span()) k = c.random.real(1.0f, 1e4f);
    auto& meetings = response::add_points(c, "meetings", 2 * kObstacles * c.items);
    for (float4& meeting : meetings.span()) {
        const bool is_one = c.random.integer(0, 2) > 0;
        meeting.w = is_one ? c.random.real(-0.3f, 0.3f) : WEFT_NO_MEETING;
    }
    auto& gradients = c.add<float>("gradients", 3 * c.items);
    for (float& g : gradients.span()) g = c.random.real(-1e3f, 1e3f);
    const int member_count = c.items + (kRows - 1) * WEFT_RUN_COLUMNS;
    auto& members = response::add_indices(c, "members", member_count, c.items);
    auto& shares = c.add<float>("shares", member_count);
    for (float& share : shares.span()) share = std::max(c.random.real(-0.2f, 1.0f), 0.0f);
    auto& column_rows = c.add<int>("column_rows", 2 * c.items);
    for (std::size_t i = 0; i < shares.count() && 2 * i < column_rows.count(); ++i) {
        column_rows[2 * i] = static_cast<int>(i);
        column_rows[2 * i + 1] = kRows;
    }
    const response::Rows rows(c, "pushes", c.items, response::kRoom);
    auto& needs = response::add_indices(c, "push_needs", c.items, 9);
    auto& codes = c.add<int>("codes", rows.entries);
    auto& sides = c.add<float4>("sides", rows.entries);
    auto& slips = c.add<float4>("slips", rows.entries);
    auto& forces = c.add<float4>("forces", rows.entries);
    auto& points = c.add<float4>("points", rows.entries);
    auto& other_points = c.add<float4>("other_points", rows.entries);
    auto& presses = c.add<float>("presses", rows.entries);
    c.launch =
        launch(kernels::collect_resting, c.segments, moved.positions, moved.previous, seen, starts,
               kept, obstacles, borne, solid, hardness, meetings, gradients, members, shares,
               column_rows, rows.rows, rows.counts, needs, codes, sides, slips, forces, points,
               other_points, presses, c.items, c.items, response::kBodies, kObstacles, 0.1f, 1e4f,
               c.random.integer(0, 1), c.random.integer(0, 1), kInstance);
}

void keep_resting_slips_case(KernelCase& c) {
    auto& obstacles = add_obstacles(c);
    const Moved moved = add_moved(c);
    auto& slips = response::add_points(c, "slips", c.items);
    c.launch = launch(kernels::keep_resting_slips, c.segments, moved.positions, moved.previous,
                      obstacles, slips, kObstacles, 0.1f, 1e-3f, kInstance);
}

/// Of solids' vertices and of others; some are not pressed.
void see_targets_case(KernelCase& c) {
    auto& targets = add_targets(c);
    auto& starts = response::add_points(c, "starts", c.items);
    auto& pressing = response::add_points(c, "pressing", c.items);
    for (float4& p : pressing.span()) {
        if (c.random.integer(0, 2) == 0) p = {};
    }
    auto& solid = add_flags(c, "solid");
    auto& seen_targets = c.add<float4>("seen_targets", c.items);
    auto& seen_starts = c.add<float4>("seen_starts", c.items);
    c.launch = launch(kernels::see_targets, c.segments, targets, starts, pressing, solid,
                      seen_targets, seen_starts);
}

const bool added = add_case("find_obstacle_planes", planes_case) &&
                   add_case("find_obstacle_meetings", meetings_case) &&
                   add_case("find_inside", inside_case) && add_case("lead_cloth", reactions_case) &&
                   add_case("find_holds", holds_case) &&
                   add_case("see_targets", see_targets_case) &&
                   add_case("collect_resting", collect_resting_case) &&
                   add_case("keep_resting_slips", keep_resting_slips_case);

}  // namespace

std::unique_ptr<KernelCase> make_obstacle_case(std::string_view kernel, int items, Flavour flavour,
                                               unsigned seed) {
    if (!kernel.starts_with("push_out_of_")) return nullptr;
    auto made = std::make_unique<KernelCase>(items, flavour, seed);
    auto& obstacles = add_obstacles(*made);
    push_case(*made, obstacles);
    finish(*made, kernels::kernel_info(std::string(kernel)));
    return made;
}

}  // namespace weft::test
