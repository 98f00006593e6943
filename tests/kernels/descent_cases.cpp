#include "kernels/bodies/reactions.h"
#include "kernels/descent/hinges.h"
#include "kernels/descent/membranes.h"
#include "kernels/descent/springs.h"
#include "kernels/descent/substep.h"
#include "kernels/descent/tetrahedra.h"
#include "kernels/sosd/membranes.h"
#include "kernels/sosd/single_vertices.h"
#include "kernels/sosd/springs.h"
#include "kernels/sosd/tetrahedra.h"
#include "kernels/vbd/solve.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRow = 3;  ///< entries per row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Positions of twice as many vertices as items: the neighbours lie behind the items' own.
Buffer<float4>& add_positions(KernelCase& c) {
    auto& positions = c.add<float4>("positions", 2 * c.items);
    for (float4& x : positions.span()) {
        x = c.random.point(1.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    return positions;
}

Buffer<int>& add_vertices(KernelCase& c) {
    auto& vertices = c.add<int>("vertices", c.items);
    const std::vector<int> order = c.random.permutation(c.items);
    std::copy(order.begin(), order.end(), vertices.data());
    return vertices;
}

/// Rows of equal length, entry k of item i at i + items * k: right for any range of items.
Buffer<int>& add_slices(KernelCase& c) {
    auto& slices = c.add<int>("slices", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        slices[at(2 * i)] = i;
        slices[at(2 * i + 1)] = kRow;
    }
    return slices;
}

/// Each item's neighbours; in degenerate cases the item's own vertex.
Buffer<int>& add_others(KernelCase& c, const Buffer<int>& vertices, int per_entry = 1) {
    auto& others = c.add<int>("others", per_entry * kRow * c.items);
    for (int e = 0; e < per_entry * kRow * c.items; ++e) {
        const bool self = c.flavour == Flavour::kDegenerate && e % 2 == 0;
        others[at(e)] =
            self ? vertices[at(e % c.items)] : c.items + c.random.integer(0, c.items - 1);
    }
    return others;
}

Buffer<float>& add_reals(KernelCase& c, const std::string& name, int count, float low, float high) {
    auto& reals = c.add<float>(name, count);
    for (float& value : reals.span()) value = c.random.real(low, high);
    return reals;
}

void springs_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& vertices = add_vertices(c);
    auto& slices = add_slices(c);
    auto& others = add_others(c, vertices);
    auto& material = add_reals(c, "material", 2 * kRow * c.items, 0.0f, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::gather_springs, c.segments, positions, vertices, slices, others,
                      material, sums, c.items, kRow * c.items, c.items, c.items % 2);
}

void bending_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& vertices = add_vertices(c);
    auto& slices = add_slices(c);
    auto& others = add_others(c, vertices);
    auto& weights = add_reals(c, "weights", kRow * c.items, -1.0f, 1.0f);
    auto& diagonal = add_reals(c, "diagonal", c.items, 0.0f, 5.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::gather_bending, c.segments, positions, vertices, slices, others,
                      weights, diagonal, sums, c.items, c.items, c.items % 2);
}

void spring_forces_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& vertices = add_vertices(c);
    auto& slices = add_slices(c);
    auto& others = add_others(c, vertices);
    auto& material = add_reals(c, "material", 2 * kRow * c.items, 0.0f, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::gather_spring_gradients, c.segments, positions, vertices, slices,
                      others, material, sums, c.items, kRow * c.items, c.items, c.items % 2);
}

void bending_forces_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& vertices = add_vertices(c);
    auto& slices = add_slices(c);
    auto& others = add_others(c, vertices);
    auto& weights = add_reals(c, "weights", kRow * c.items, -1.0f, 1.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::gather_bending_gradients, c.segments, positions, vertices, slices,
                      others, weights, sums, c.items, c.items, c.items % 2);
}

/// Tetrahedra or membranes, with `others` other corners and `shape` numbers of their shape.
template <class Kernel>
void elastic_case(KernelCase& c, Kernel kernel, int others_per_entry, int shape_columns) {
    auto& positions = add_positions(c);
    auto& vertices = add_vertices(c);
    auto& slices = add_slices(c);
    auto& others = add_others(c, vertices, others_per_entry);
    auto& shape = add_reals(c, "shape", shape_columns * kRow * c.items, -3.0f, 3.0f);
    auto& material = add_reals(c, "material", 2 * kRow * c.items, 0.0f, 2.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernel, c.segments, positions, vertices, slices, others, shape, material,
                      sums, c.items, kRow * c.items, c.items, c.items % 2);
}

void tetrahedra_case(KernelCase& c) { elastic_case(c, kernels::gather_tetrahedra, 3, 9); }
void membranes_case(KernelCase& c) { elastic_case(c, kernels::gather_membranes, 2, 4); }
void tetrahedra_forces_case(KernelCase& c) {
    elastic_case(c, kernels::gather_tetrahedra_gradients, 3, 9);
}
void membrane_forces_case(KernelCase& c) {
    elastic_case(c, kernels::gather_membrane_gradients, 2, 4);
}

void solve_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& targets = c.add<float4>("targets", 2 * c.items);
    for (float4& x : targets.span()) x = c.random.point(1.0f);
    auto& vertices = add_vertices(c);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    for (int i = 0; i < c.items; ++i) {
        for (const int diagonal : {3, 6, 8}) {
            sums[at(i + diagonal * c.items)] = c.flavour == Flavour::kRandom ? 3.0f : 0.0f;
        }
        for (int k = 3; k < 9; ++k) {
            if (c.flavour == Flavour::kDegenerate && i % 2 == 0) sums[at(i + k * c.items)] = 0.0f;
        }
    }
    c.launch = launch(kernels::solve_vertices, c.segments, positions, targets, vertices, sums,
                      c.items, 1e2f);
}

/// Stencils of so many corners; `tables` adds the buffers of their elements.
template <class Kernel, class... Tables>
void stencils_case(KernelCase& c, Kernel kernel, int corner_count, Tables... tables) {
    const int items = corner_count * c.items;
    auto& positions = c.add<float4>("positions", items);
    auto& targets = c.add<float4>("targets", items);
    auto& vertices = c.add<int>("vertices", items);
    auto& corners = c.add<int>("corners", items);
    auto& sums = add_reals(c, "sums", 9 * items, -1.0f, 1.0f);
    const std::vector<int> order = c.random.permutation(items);
    for (int i = 0; i < items; ++i) {
        // Degenerate: all in one point, and some with neither stiffness nor force.
        const bool is_point = c.flavour == Flavour::kDegenerate;
        positions[at(i)] = c.random.point(is_point ? 0.0f : 1.0f);
        positions[at(i)].w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 10.0f);
        targets[at(i)] = is_point ? positions[at(i)] : c.random.point(1.0f);
        vertices[at(i)] = order[at(i)];
        corners[at(i)] = i;
        for (const int diagonal : {3, 6, 8}) sums[at(i + diagonal * items)] = 5.0f;
        for (int k = 0; k < 9; ++k) {
            if (is_point && i % 2 == 0) sums[at(i + k * items)] = 0.0f;
        }
    }
    c.launch = launch(kernel, c.segments, positions, targets, vertices, corners, tables(c)..., sums,
                      c.items, items, 1e2f);
}

void single_case(KernelCase& c) { stencils_case(c, kernels::solve_single_vertices, 1); }

Buffer<float>& add_material(KernelCase& c) {
    return add_reals(c, "material", 2 * c.items, 0.0f, 2.0f);
}
void spring_stencils_case(KernelCase& c) {
    stencils_case(c, kernels::solve_spring_stencils, 2, add_material);
}
void membrane_stencils_case(KernelCase& c) {
    const auto add_shape = [](KernelCase & d) -> auto& {
        return add_reals(d, "shape", 4 * d.items, -3.0f, 3.0f);
    };
    stencils_case(c, kernels::solve_membrane_stencils, 3, add_shape, add_material);
}
void tetrahedron_stencils_case(KernelCase& c) {
    const auto add_shape = [](KernelCase & d) -> auto& {
        return add_reals(d, "shape", 9 * d.items, -3.0f, 3.0f);
    };
    stencils_case(c, kernels::solve_tetrahedron_stencils, 4, add_shape, add_material);
}

void begin_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& previous = c.add<float4>("previous", 2 * c.items);
    auto& targets = c.add<float4>("targets", 2 * c.items);
    auto& velocities = c.add<float4>("velocities", 2 * c.items);
    for (float4& d : targets.span()) d = c.random.point(2e-3f);
    for (float4& v : velocities.span()) v = c.random.point(3.0f);
    auto& gravity = c.add<float4>("gravity", 2);
    if (c.flavour == Flavour::kRandom) gravity[1] = {1.0f, -9.81f, 0.5f, 0.0f};
    c.launch = launch(kernels::begin_descent, c.segments, positions, previous, targets, velocities,
                      gravity, 0.01f, 1e-4f, kInstance);
}

void keep_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& targets = c.add<float4>("targets", 2 * c.items);
    for (float4& x : targets.span()) x = c.random.point(1.0f);
    c.launch = launch(kernels::keep_deviation, c.segments, positions, targets);
}

void copy_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& copy = c.add<float4>("copy", 2 * c.items);
    c.launch = launch(kernels::copy_positions, c.segments, positions, copy);
}

void start_pressing_case(KernelCase& c) {
    auto& pressing = add_positions(c);
    c.launch = launch(kernels::start_pressing, c.segments, pressing);
}

void start_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& targets = c.add<float4>("targets", 2 * c.items);
    c.launch = launch(kernels::start_targets, c.segments, positions, targets);
}

/// Some have been pushed, hardly at all or not, some by planes, and some are held.
void reactions_case(KernelCase& c) {
    auto& positions = add_positions(c);
    auto& starts = add_positions(c);
    auto& targets = c.add<float4>("targets", 2 * c.items);
    for (int v = 0; v < 2 * c.items; ++v) {
        const float4 push = c.random.point(c.random.integer(0, 2) == 0 ? 1e-9f : 0.1f);
        const float4 x = starts[at(v)];
        const float grip = c.random.integer(0, 1) == 0 ? 0.0f : c.random.real(0.0f, 1e-2f);
        targets[at(v)] = {x.x + push.x, x.y + push.y, x.z + push.z, grip};
    }
    auto& borne = c.add<float>("borne", 2 * c.items);
    for (float& one : borne.span()) one = static_cast<float>(c.random.integer(0, 1));
    auto& vertices = add_vertices(c);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    auto& pressing = c.add<float4>("pressing", 2 * c.items);
    for (float4& p : pressing.span()) {
        p = c.random.point(0.1f);
        p.w = c.random.integer(0, 3) == 0 ? 1.0f : 0.0f;
    }
    c.launch = launch(kernels::lead_by_reactions, c.segments, positions, starts, targets, borne,
                      vertices, sums, pressing, c.items, 1e4f);
}

const bool added =
    add_case("gather_springs", springs_case) && add_case("gather_bending", bending_case) &&
    add_case("gather_spring_gradients", spring_forces_case) &&
    add_case("gather_bending_gradients", bending_forces_case) &&
    add_case("gather_tetrahedra", tetrahedra_case) &&
    add_case("gather_membranes", membranes_case) &&
    add_case("gather_tetrahedra_gradients", tetrahedra_forces_case) &&
    add_case("gather_membrane_gradients", membrane_forces_case) &&
    add_case("solve_vertices", solve_case) && add_case("solve_single_vertices", single_case) &&
    add_case("solve_spring_stencils", spring_stencils_case) &&
    add_case("solve_membrane_stencils", membrane_stencils_case) &&
    add_case("solve_tetrahedron_stencils", tetrahedron_stencils_case) &&
    add_case("begin_descent", begin_case) && add_case("keep_deviation", keep_case) &&
    add_case("copy_positions", copy_case) && add_case("start_targets", start_case) &&
    add_case("start_pressing", start_pressing_case) &&
    add_case("lead_by_reactions", reactions_case);

}  // namespace
}  // namespace weft::test
