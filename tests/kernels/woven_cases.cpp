// Woven cloth: triangles with a material of three numbers.

#include "kernels/descent/woven.h"
#include "kernels/sosd/woven.h"
#include "kernels/xpbd/woven.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRow = 3;  ///< entries per row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Buffer<float>& add_reals(KernelCase& c, const std::string& name, int count, float low, float high) {
    auto& reals = c.add<float>(name, count);
    for (float& value : reals.span()) value = c.random.real(low, high);
    return reals;
}

/// Positions of `count` vertices; in degenerate cases triangles of `rows` are points, lines or
/// held.
Buffer<float4>& add_positions(KernelCase& c, int count, int rows) {
    auto& positions = c.add<float4>("positions", count);
    for (int v = 0; v < count; ++v) {
        float4& x = positions[at(v)];
        x = c.random.point(1.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 10.0f);
        if (c.flavour == Flavour::kRandom) continue;
        const int kind = v % rows % 4;
        if (kind == 0) x = {0.5f, 0.25f, 0.0f, x.w};
        if (kind == 1) x = {0.5f * static_cast<float>(v / rows), 0.0f, 0.0f, x.w};
        if (kind == 2) x.w = 0.0f;
    }
    return positions;
}

/// Corner k of triangle i is vertex i + k * items.
Buffer<int>& add_corners(KernelCase& c) {
    auto& corners = c.add<int>("corners", 3 * c.items);
    for (int i = 0; i < 3 * c.items; ++i) corners[at(i)] = i;
    return corners;
}

void project_case(KernelCase& c) {
    auto& positions = add_positions(c, 3 * c.items, c.items);
    auto& corners = add_corners(c);
    auto& shape = add_reals(c, "shape", 4 * c.items, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 3 * c.items, 1e-3f, 1e2f);
    for (int i = 0; c.flavour == Flavour::kDegenerate && i < c.items; i += 3) {
        material[at(i + 2 * c.items)] = 1e-9f;  // next to no shear stiffness
    }
    auto& warp = add_reals(c, "of_warp", c.items, -1e-3f, 1e-3f);
    auto& weft = add_reals(c, "of_weft", c.items, -1e-3f, 1e-3f);
    auto& shear = add_reals(c, "of_shear", c.items, -1e-3f, 1e-3f);
    c.launch = launch(kernels::project_woven, c.segments, positions, corners, shape, material, warp,
                      weft, shear, c.items, 1e4f, c.items % 2);
}

void terms_case(KernelCase& c) {
    auto& positions = add_positions(c, 3 * c.items, c.items);
    auto& corners = add_corners(c);
    auto& shape = add_reals(c, "shape", 4 * c.items, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 3 * c.items, 1e-3f, 1e2f);
    auto& slots = c.add<int>("slots", c.items);
    for (int i = 0; i < c.items; ++i) slots[at(i)] = i;
    auto& terms = c.add<float>("terms", c.items);
    c.launch = launch(kernels::woven_terms, c.segments, positions, corners, shape, material, slots,
                      terms, c.items);
}

/// Rows of equal length, entry k of item i at i + items * k; item i is vertex i, and the others lie
/// behind all items.
template <class Kernel>
void gather_case(KernelCase& c, Kernel kernel) {
    const int entries = kRow * c.items;
    auto& positions = add_positions(c, c.items + 2 * entries, c.items);
    auto& vertices = c.add<int>("vertices", c.items);
    auto& slices = c.add<int>("slices", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        vertices[at(i)] = i;
        slices[at(2 * i)] = i;
        slices[at(2 * i + 1)] = kRow;
    }
    auto& others = c.add<int>("others", 2 * entries);
    for (int e = 0; e < 2 * entries; ++e) {
        const bool fills_up = c.flavour == Flavour::kDegenerate && e % 5 == 0;
        others[at(e)] = fills_up ? e % c.items : c.items + e;
    }
    auto& shape = add_reals(c, "shape", 4 * entries, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 3 * entries, 0.0f, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernel, c.segments, positions, vertices, slices, others, shape, material,
                      sums, c.items, entries, c.items, c.items % 2);
}

void stencils_case(KernelCase& c) {
    const int items = 3 * c.items;
    auto& positions = add_positions(c, items, c.items);
    auto& targets = c.add<float4>("targets", items);
    auto& vertices = c.add<int>("vertices", items);
    auto& corners = add_corners(c);
    auto& shape = add_reals(c, "shape", 4 * c.items, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 3 * c.items, 0.0f, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * items, -1.0f, 1.0f);
    for (int i = 0; i < items; ++i) {
        targets[at(i)] = c.random.point(1.0f);
        vertices[at(i)] = i;
        for (const int diagonal : {3, 6, 8}) sums[at(i + diagonal * items)] = 60.0f;
    }
    c.launch = launch(kernels::solve_woven_stencils, c.segments, positions, targets, vertices,
                      corners, shape, material, sums, c.items, items, 1e2f);
}

void gather_all_case(KernelCase& c) { gather_case(c, kernels::gather_woven); }
void gather_gradients_case(KernelCase& c) { gather_case(c, kernels::gather_woven_gradients); }

const bool added = add_case("project_woven", project_case) && add_case("woven_terms", terms_case) &&
                   add_case("gather_woven", gather_all_case) &&
                   add_case("gather_woven_gradients", gather_gradients_case) &&
                   add_case("solve_woven_stencils", stencils_case);

}  // namespace
}  // namespace weft::test
