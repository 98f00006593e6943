#include "kernels/xpbd/springs.h"

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

void springs_case(KernelCase& c, int fresh) {
    const int count = c.items;
    auto& positions = c.add<float4>("positions", 2 * count);
    auto& ends = c.add<int>("ends", 2 * count);
    auto& material = c.add<float>("material", 2 * count);
    auto& multipliers = c.add<float>("multipliers", count);

    const std::vector<int> vertices = c.random.permutation(2 * count);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        ends[v] = vertices[v];
        positions[v] = c.random.point(1.0f);
        positions[v].w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    for (int i = 0; i < count; ++i) {
        const auto s = static_cast<std::size_t>(i);
        material[s] = c.random.real(0.0f, 2.0f);
        material[s + static_cast<std::size_t>(count)] = c.random.real(1e-7f, 1e-1f);
        multipliers[s] = c.random.real(-1e-3f, 1e-3f);
        if (c.flavour == Flavour::kRandom) continue;
        float4& x0 = positions[static_cast<std::size_t>(vertices[s])];
        float4& x1 =
            positions[static_cast<std::size_t>(vertices[s + static_cast<std::size_t>(count)])];
        if (i % 5 < 3) x1 = x0;                                  // no length
        if (i % 5 == 0) material[s] = 0.0f;                      // and none at rest
        if (i % 5 == 1) x0.w = x1.w = 0.0f;                      // both ends held
        if (i % 5 == 3) x1 = {x0.x + 1e-23f, x0.y, x0.z, x1.w};  // a length whose square is 0
        if (i % 5 == 4) x1.x = x0.x + 1e18f;
    }
    c.launch = launch(kernels::project_springs, c.segments, positions, ends, material, multipliers,
                      count, 1e4f, fresh);
}

const bool added = add_case("project_springs", [](KernelCase& c) { springs_case(c, c.items % 2); });

}  // namespace
}  // namespace weft::test
