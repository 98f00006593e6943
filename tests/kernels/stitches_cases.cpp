#include "kernels/descent/stitches.h"
#include "kernels/xpbd/stitches.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRow = 3;  ///< entries per row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// start [m], a stiffness or its inverse, rate [1/s]; some have no length at the start.
Buffer<float>& add_material(KernelCase& c, int count) {
    auto& material = c.add<float>("material", 3 * count);
    for (float& value : material.span()) value = c.random.real(0.1f, 2.0f);
    for (int i = 0; i < count; ++i) {
        if (c.flavour == Flavour::kDegenerate && i % 2 == 0) material[at(i)] = 0.0f;
    }
    return material;
}

/// Times before and after the closing of most.
Buffer<float>& add_clock(KernelCase& c) {
    auto& clock = c.add<float>("clock", 2);
    clock[0] = 0.25f;
    clock[1] = 1.5f;
    return clock;
}

Buffer<float4>& add_positions(KernelCase& c) {
    auto& positions = c.add<float4>("positions", 2 * c.items);
    for (float4& x : positions.span()) {
        x = c.random.point(c.flavour == Flavour::kDegenerate ? 0.0f : 1.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    return positions;
}

Buffer<int>& add_ends(KernelCase& c) {
    auto& ends = c.add<int>("ends", 2 * c.items);
    const std::vector<int> order = c.random.permutation(2 * c.items);
    std::copy(order.begin(), order.end(), ends.data());
    return ends;
}

void project_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& ends = add_ends(c);
    auto& material = add_material(c, c.items);
    auto& clock = add_clock(c);
    auto& multipliers = c.add<float>("multipliers", c.items);
    for (float& value : multipliers.span()) value = c.random.real(-1e-3f, 1e-3f);
    c.launch = launch(kernels::project_stitches, c.segments, positions, ends, material, clock,
                      multipliers, c.items, 1e2f, c.items % 2, kInstance);
}

template <class Kernel>
void gather_case(KernelCase& c, Kernel kernel) {
    auto& positions = add_positions(c);
    auto& vertices = c.add<int>("vertices", c.items);
    const std::vector<int> order = c.random.permutation(c.items);
    std::copy(order.begin(), order.end(), vertices.data());
    auto& slices = c.add<int>("slices", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        slices[at(2 * i)] = i;
        slices[at(2 * i + 1)] = kRow;
    }
    auto& others = c.add<int>("others", kRow * c.items);
    for (int& other : others.span()) other = c.items + c.random.integer(0, c.items - 1);
    auto& material = add_material(c, kRow * c.items);
    auto& clock = add_clock(c);
    auto& sums = c.add<float>("sums", 9 * c.items);
    for (float& value : sums.span()) value = c.random.real(-1.0f, 1.0f);
    c.launch = launch(kernel, c.segments, positions, vertices, slices, others, material, clock,
                      sums, c.items, kRow * c.items, c.items, c.items % 2, kInstance);
}

void gather_all_case(KernelCase& c) { gather_case(c, kernels::gather_stitches); }
void gather_gradients_case(KernelCase& c) { gather_case(c, kernels::gather_stitch_gradients); }

void terms_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& ends = add_ends(c);
    auto& material = add_material(c, c.items);
    auto& clock = add_clock(c);
    auto& slots = c.add<int>("slots", c.items);
    for (int i = 0; i < c.items; ++i) slots[at(i)] = i;
    auto& terms = c.add<float>("terms", c.items);
    c.launch = launch(kernels::stitch_terms, c.segments, positions, ends, material, clock, slots,
                      terms, c.items, kInstance);
}

const bool added = add_case("project_stitches", project_case) &&
                   add_case("gather_stitches", gather_all_case) &&
                   add_case("gather_stitch_gradients", gather_gradients_case) &&
                   add_case("stitch_terms", terms_case);

}  // namespace
}  // namespace weft::test
