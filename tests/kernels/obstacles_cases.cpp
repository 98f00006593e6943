// Every shape has kernels of the same signature, so a new shape is tested without another line
// here.

#include "kernels/obstacles/contact.h"

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
        const bool is_swept = c.flavour != Flavour::kRandom || i % 2 == 1;
        rows[7] = {0.01f, 0.3f, is_swept ? 1.0f : 0.0f, 0.0f};
    }
}

void obstacle_case(KernelCase& c, const kernels::KernelInfo& kernel) {
    auto& positions = c.add<float4>("positions", c.items);
    auto& previous = c.add<float4>("previous", c.items);
    auto& obstacles = c.add<float4>("obstacles", kSubsteps * kObstacles * WEFT_OBSTACLE_ROWS);
    place(c, obstacles);
    const float special[] = {0.0f, 0.25f, -0.25f,
                             0.5f, -0.5f, 1.0f};  // centres, faces, edges, corners
    for (std::size_t v = 0; v < positions.count(); ++v) {
        positions[v] = c.random.point(0.8f);
        if (c.flavour == Flavour::kDegenerate) {
            const auto pick = [&] { return special[c.random.integer(0, 5)]; };
            positions[v] = {pick(), pick(), pick(), 0.0f};
        }
        const float moved = c.flavour == Flavour::kRandom ? 0.9f : 0.0f;
        const float4 way = c.random.point(moved);
        const float4& x = positions[v];
        previous[v] = {x.x + way.x, x.y + way.y, x.z + way.z, 0.0f};
        positions[v].w = c.random.integer(0, 5) == 0 ? 0.0f : 1.0f;
    }

    Argument substep;
    substep.run_value = RunValue::kOfInstance;
    Argument count;
    count.integer = kObstacles;
    Argument which;
    which.integer = 1;
    c.launch.kernel = &kernel;
    c.launch.segments = c.segments;
    c.launch.arguments = {{&positions}, {&previous}};
    if (kernel.name.starts_with("rub_on_")) {
        auto& grips = c.add<float4>("grips", c.items);
        for (float4& grip : grips.span()) grip = c.random.point(0.1f);
        for (float4& grip : grips.span()) grip.w = std::max(c.random.real(-0.1f, 0.1f), 0.0f);
        Argument has_grips, is_last;
        has_grips.integer = c.random.integer(0, 1);
        is_last.integer = c.random.integer(0, 1);
        c.launch.arguments.insert(c.launch.arguments.end(),
                                  {{&grips}, {&obstacles}, has_grips, is_last});
    } else {
        c.launch.arguments.push_back({&obstacles});
    }
    c.launch.arguments.insert(c.launch.arguments.end(), {count, which, substep});
}

}  // namespace

std::unique_ptr<KernelCase> make_obstacle_case(std::string_view kernel, int items, Flavour flavour,
                                               unsigned seed) {
    if (!kernel.starts_with("push_out_of_") && !kernel.starts_with("rub_on_")) return nullptr;
    auto made = std::make_unique<KernelCase>(items, flavour, seed);
    obstacle_case(*made, kernels::kernel_info(std::string(kernel)));
    return made;
}

}  // namespace weft::test
