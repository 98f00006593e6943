#include "kernels/xpbd/hinges.h"

#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

void hinges_case(KernelCase& c) {
    const int count = c.items;
    auto& positions = c.add<float4>("positions", 4 * count);
    auto& corners = c.add<int>("corners", 4 * count);
    auto& weights = c.add<float>("weights", 4 * count);
    auto& multipliers = c.add<float>("multipliers", count);

    const std::vector<int> vertices = c.random.permutation(4 * count);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        corners[v] = vertices[v];
        positions[v] = c.random.point(1.0f);
        positions[v].w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
        weights[v] = c.random.real(-1.0f, 1.0f);
    }
    for (int i = 0; i < count; ++i) {
        const auto h = static_cast<std::size_t>(i);
        const auto rows = static_cast<std::size_t>(count);
        multipliers[h] = c.random.real(-1e-3f, 1e-3f);
        if (c.flavour == Flavour::kRandom) continue;
        for (std::size_t k = 0; k < 4; ++k) {
            float4& x = positions[static_cast<std::size_t>(vertices[h + k * rows])];
            if (i % 4 == 0) x = {0.5f, 0.25f, 0.0f, x.w};                         // one point
            if (i % 4 == 1) x = {static_cast<float>(k) * 0.5f, 0.0f, 0.0f, x.w};  // collinear
            if (i % 4 == 2) weights[h + k * rows] = 0.0f;                         // no stiffness
            if (i % 4 == 3) x.w = 0.0f;                                           // all held
        }
    }
    c.launch = launch(kernels::project_hinges, c.segments, positions, corners, weights, multipliers,
                      count, 1e4f, c.items % 2);
}

const bool added = add_case("project_hinges", hinges_case);

}  // namespace
}  // namespace weft::test
