// Every shape has kernels of the same signature, so a new shape is tested without another line
// here.

#include "kernels/obstacles/contact.h"

#include <limits>

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kObstacles = 2;
constexpr int kSubsteps = 3;

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
        rows[7] = {0.01f, friction, swept_from[which], 0.0f};
    }
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

/// Behind the arguments of its own: how many obstacles there are, which one, and the substep.
void finish(KernelCase& c, const kernels::KernelInfo& kernel) {
    Argument substep;
    substep.run_value = RunValue::kOfInstance;
    Argument count;
    count.integer = kObstacles;
    Argument which;
    which.integer = 1;
    c.launch.kernel = &kernel;
    c.launch.segments = c.segments;
    c.launch.arguments.insert(c.launch.arguments.end(), {count, which, substep});
}

void push_case(KernelCase& c, Buffer<float4>& obstacles) {
    auto& positions = c.add<float4>("positions", c.items);
    auto& previous = c.add<float4>("previous", c.items);
    auto& targets = add_targets(c);
    scatter(c, positions);
    for (std::size_t v = 0; v < positions.count(); ++v) {
        const float moved = c.flavour == Flavour::kRandom ? 0.9f : 0.0f;
        const float4 way = c.random.point(moved);
        const float4& x = positions[v];
        previous[v] = {x.x + way.x, x.y + way.y, x.z + way.z, 0.0f};
        positions[v].w = c.random.integer(0, 5) == 0 ? 0.0f : 1.0f;
    }
    Argument told;
    told.integer = c.random.integer(WEFT_PUSH_ALONE, WEFT_PUSH_LAST);
    c.launch.arguments = {{&positions}, {&previous}, {&targets}, {&obstacles}, told};
}

}  // namespace

std::unique_ptr<KernelCase> make_obstacle_case(std::string_view kernel, int items, Flavour flavour,
                                               unsigned seed) {
    if (!kernel.starts_with("push_out_of_")) return nullptr;
    auto made = std::make_unique<KernelCase>(items, flavour, seed);
    auto& obstacles = made->add<float4>("obstacles", kSubsteps * kObstacles * WEFT_OBSTACLE_ROWS);
    place(*made, obstacles);
    push_case(*made, obstacles);
    finish(*made, kernels::kernel_info(std::string(kernel)));
    return made;
}

}  // namespace weft::test
