// Tetrahedra and membranes: constraints of the same form, over four corners and over three.

#include "kernels/xpbd/membranes.h"
#include "kernels/xpbd/tetrahedra.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

/// Elements of `arity` corners with random rest shapes (`shape_columns` numbers each).
struct Elastic {
    Buffer<float4>& positions;
    Buffer<int>& corners;
    Buffer<float>& shape;
    Buffer<float>& material;
    Buffer<float>& first;
    Buffer<float>& second;

    Elastic(KernelCase& c, int arity, int shape_columns)
        : positions(c.add<float4>("positions", arity * c.items)),
          corners(c.add<int>("corners", arity * c.items)),
          shape(c.add<float>("shape", shape_columns * c.items)),
          material(c.add<float>("material", 2 * c.items)),
          first(c.add<float>("first multipliers", c.items)),
          second(c.add<float>("second multipliers", c.items)) {
        const std::vector<int> vertices = c.random.permutation(arity * c.items);
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            corners[v] = vertices[v];
            positions[v] = c.random.point(1.0f);
            positions[v].w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
        }
        for (float& b : shape.span()) b = c.random.real(-3.0f, 3.0f);
        for (float& modulus : material.span()) modulus = c.random.real(1e-3f, 1e2f);
        for (float& multiplier : first.span()) multiplier = c.random.real(-1e-3f, 1e-3f);
        for (float& multiplier : second.span()) multiplier = c.random.real(-1e-3f, 1e-3f);
        if (c.flavour == Flavour::kRandom) return;
        for (int i = 0; i < c.items; ++i) spoil(static_cast<std::size_t>(i), arity);
    }

    void spoil(std::size_t i, int arity) {
        const std::size_t rows = first.count();
        for (int k = 0; k < arity; ++k) {
            const auto corner =
                static_cast<std::size_t>(corners[i + static_cast<std::size_t>(k) * rows]);
            float4& x = positions[corner];
            if (i % 6 == 0) x = {0.5f, 0.25f, 0.0f, x.w};                         // one point
            if (i % 6 == 1) x = {static_cast<float>(k) * 0.5f, 0.0f, 0.0f, x.w};  // one line
            if (i % 6 == 2) x.z = 0.5f;                                           // one plane
            if (i % 6 == 3) x.w = 0.0f;                                           // all held
        }
        if (i % 6 == 4) material[rows + i] = 1e6f * material[i];   // nearly incompressible
        if (i % 6 == 5) material[i] = 1e-6f * material[rows + i];  // nearly a fluid
    }
};

void tetrahedra_case(KernelCase& c) {
    Elastic e(c, 4, 9);
    c.launch = launch(kernels::project_tetrahedra, c.segments, e.positions, e.corners, e.shape,
                      e.material, e.first, e.second, c.items, 1e4f, c.items % 2);
}

void membranes_case(KernelCase& c) {
    Elastic e(c, 3, 4);
    c.launch = launch(kernels::project_membranes, c.segments, e.positions, e.corners, e.shape,
                      e.material, e.first, e.second, c.items, 1e4f, c.items % 2);
}

const bool added = add_case("project_tetrahedra", tetrahedra_case) &&
                   add_case("project_membranes", membranes_case);

}  // namespace
}  // namespace weft::test
