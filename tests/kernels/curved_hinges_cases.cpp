#include "kernels/descent/curved_hinges.h"
#include "kernels/xpbd/curved_hinges.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRow = 3;  ///< entries per row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Buffer<float>& add_reals(KernelCase& c, const std::string& name, int count, float size) {
    auto& reals = c.add<float>(name, count);
    for (float& value : reals.span()) value = c.random.real(-size, size);
    return reals;
}

Buffer<float4>& add_positions(KernelCase& c, int count) {
    auto& positions = c.add<float4>("positions", count);
    for (float4& x : positions.span()) {
        x = c.random.point(1.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    return positions;
}

/// Degenerate: all in one point, in a line, without stiffness, all held.
void make_degenerate(KernelCase& c, Buffer<float4>& positions, const Buffer<int>& corners,
                     Buffer<float>& weights) {
    for (int i = 0; i < c.items; ++i) {
        for (int k = 0; k < 6; ++k) {
            if (i % 4 == 2) weights[at(i + k * c.items)] = 0.0f;
            if (k > 3) continue;
            float4& x = positions[at(corners[at(i + k * c.items)])];
            if (i % 4 == 0) x = {0.5f, 0.25f, 0.0f, x.w};
            if (i % 4 == 1) x = {static_cast<float>(k) * 0.5f, 0.0f, 0.0f, x.w};
            if (i % 4 == 3) x.w = 0.0f;
        }
    }
}

void project_case(KernelCase& c) {
    auto& positions = add_positions(c, 4 * c.items);
    auto& corners = c.add<int>("corners", 4 * c.items);
    const std::vector<int> vertices = c.random.permutation(4 * c.items);
    std::copy(vertices.begin(), vertices.end(), corners.data());
    auto& weights = add_reals(c, "weights", 6 * c.items, 1.0f);
    auto& multipliers = add_reals(c, "multipliers", c.items, 1e-3f);
    if (c.flavour == Flavour::kDegenerate) make_degenerate(c, positions, corners, weights);
    c.launch = launch(kernels::project_curved_hinges, c.segments, positions, corners, weights,
                      multipliers, c.items, 1e4f, c.items % 2);
}

template <class Kernel>
void gather_case(KernelCase& c, Kernel kernel) {
    auto& positions = add_positions(c, 2 * c.items);
    auto& vertices = c.add<int>("vertices", c.items);
    const std::vector<int> order = c.random.permutation(c.items);
    std::copy(order.begin(), order.end(), vertices.data());
    auto& slices = c.add<int>("slices", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        slices[at(2 * i)] = i;
        slices[at(2 * i + 1)] = kRow;
    }
    const int entries = kRow * c.items;
    auto& others = c.add<int>("others", 3 * entries);
    for (int e = 0; e < 3 * entries; ++e) {
        const bool self = c.flavour == Flavour::kDegenerate && e % 2 == 0;
        others[at(e)] =
            self ? vertices[at(e % c.items)] : c.items + c.random.integer(0, c.items - 1);
    }
    auto& weights = add_reals(c, "weights", 6 * entries, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, 1.0f);
    c.launch = launch(kernel, c.segments, positions, vertices, slices, others, weights, sums,
                      c.items, entries, c.items, c.items % 2);
}

void gather_all_case(KernelCase& c) { gather_case(c, kernels::gather_curved_hinges); }
void gather_forces_case(KernelCase& c) { gather_case(c, kernels::gather_curved_hinge_gradients); }

void terms_case(KernelCase& c) {
    auto& positions = add_positions(c, 4 * c.items);
    auto& corners = c.add<int>("corners", 4 * c.items);
    for (int& vertex : corners.span()) vertex = c.random.integer(0, 4 * c.items - 1);
    auto& weights = add_reals(c, "weights", 6 * c.items, 2.0f);
    auto& slots = c.add<int>("slots", c.items);
    for (int i = 0; i < c.items; ++i) slots[at(i)] = i;
    auto& terms = c.add<float>("terms", c.items);
    c.launch = launch(kernels::curved_hinge_terms, c.segments, positions, corners, weights, slots,
                      terms, c.items);
}

const bool added = add_case("project_curved_hinges", project_case) &&
                   add_case("gather_curved_hinges", gather_all_case) &&
                   add_case("gather_curved_hinge_gradients", gather_forces_case) &&
                   add_case("curved_hinge_terms", terms_case);

}  // namespace
}  // namespace weft::test
