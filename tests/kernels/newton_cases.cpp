#include "kernels/newton/blocks.h"
#include "kernels/newton/coarse.h"
#include "kernels/newton/conjugate_gradients.h"
#include "kernels/newton/control.h"
#include "kernels/newton/hinges.h"
#include "kernels/newton/springs.h"
#include "kernels/newton/tetrahedra.h"
#include "kernels/newton/triangles.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRow = 3;  ///< entries per row

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (float4& x : points.span()) {
        x = c.random.point(c.flavour == Flavour::kRandom ? 1.0f : 0.0f);
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.1f, 1e4f);
    }
    return points;
}

Buffer<float>& add_reals(KernelCase& c, const std::string& name, int count, float low, float high) {
    auto& reals = c.add<float>(name, count);
    for (float& value : reals.span()) value = c.random.real(low, high);
    return reals;
}

/// Places in something of that size.
Buffer<int>& add_indices(KernelCase& c, const std::string& name, int count, int size) {
    auto& indices = c.add<int>(name, count);
    for (int& index : indices.span()) index = c.random.integer(0, size - 1);
    return indices;
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

/// Of blocks: symmetric ones and any. The items are the blocks.
int columns_of(const KernelCase& c) { return c.items % 2 == 0 ? 6 : 9; }

template <class Kernel>
void elastic_case(KernelCase& c, Kernel kernel, int corner_count, int shape_columns,
                  int material_columns) {
    const int entries = kRow * c.items;
    auto& positions = add_points(c, "positions", 20);
    auto& slices = add_slices(c);
    auto& corners = add_indices(c, "corners", corner_count * entries, 20);
    auto& shape = add_reals(c, "shape", shape_columns * entries, -2.0f, 2.0f);
    auto& material = add_reals(c, "material", material_columns * entries, 0.0f, 2.0f);
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    if (c.flavour == Flavour::kDegenerate) {
        for (std::size_t e = 0; e < material.count(); e += 3) material[e] = 0.0f;
    }
    c.launch = launch(kernel, c.segments, positions, slices, corners, shape, material, blocks,
                      c.items, entries, columns_of(c), c.items, c.items % 3 == 0 ? 1 : 0);
}

void membranes_case(KernelCase& c) { elastic_case(c, kernels::couple_membranes, 3, 4, 2); }
void woven_case(KernelCase& c) { elastic_case(c, kernels::couple_woven, 3, 4, 3); }

void tetrahedra_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", 20);
    auto& corners = add_indices(c, "corners", 4 * c.items, 20);
    auto& shape = add_reals(c, "shape", 9 * c.items, -2.0f, 2.0f);
    auto& material = add_reals(c, "material", 2 * c.items, 0.0f, 2.0f);
    auto& places = c.add<int>("places", c.items);
    for (int i = 0; i < c.items; ++i) places[at(i)] = 18 * i;
    auto& blocks = c.add<float4>("element_blocks", 18 * c.items);
    if (c.flavour == Flavour::kDegenerate) {
        for (std::size_t e = 0; e < material.count(); e += 3) material[e] = 0.0f;
    }
    c.launch = launch(kernels::block_tetrahedra, c.segments, positions, corners, shape, material,
                      places, blocks, c.items);
}

void element_blocks_case(KernelCase& c) {
    const int entries = kRow * c.items;
    auto& slices = add_slices(c);
    auto& element_blocks = add_points(c, "element_blocks", 3 * 20);
    auto& places = add_indices(c, "places", entries, 20);
    for (int& place : places.span()) place *= 3;
    auto& turned = c.add<float>("turned", entries);
    for (float& turn : turned.span()) turn = static_cast<float>(c.random.integer(0, 1));
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::sum_element_blocks, c.segments, slices, element_blocks, places,
                      turned, blocks, c.items, columns_of(c), c.items, c.items % 3 == 0 ? 1 : 0);
}

void springs_case(KernelCase& c) {
    const int entries = kRow * c.items;
    auto& positions = add_points(c, "positions", 20);
    auto& before = add_points(c, "before", 20);
    auto& after = add_points(c, "after", 20);
    auto& slices = add_slices(c);
    auto& corners = add_indices(c, "corners", 2 * entries, 20);
    auto& material = add_reals(c, "material", 2 * entries, 0.0f, 2.0f);
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::couple_springs, c.segments, positions, before, after, slices,
                      corners, material, blocks, c.items, entries, columns_of(c), c.items,
                      c.items % 3 == 0 ? 1 : 0);
}

void stitches_case(KernelCase& c) {
    const int entries = kRow * c.items;
    auto& positions = add_points(c, "positions", 20);
    auto& slices = add_slices(c);
    auto& corners = add_indices(c, "corners", 2 * entries, 20);
    auto& material = add_reals(c, "material", 3 * entries, 0.0f, 2.0f);
    auto& clock = c.add<float>("clock", 2);
    clock[0] = 0.25f;
    clock[1] = 1.5f;
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::couple_stitches, c.segments, positions, slices, corners, material,
                      clock, blocks, c.items, entries, columns_of(c), c.items,
                      c.items % 3 == 0 ? 1 : 0, kInstance);
}

void hinges_case(KernelCase& c) {
    auto& weights = add_reals(c, "weights", c.items, -1.0f, 1.0f);
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::couple_hinges, c.segments, weights, blocks, c.items,
                      c.items % 2 == 0 ? 1 : 9, c.items % 3 == 0 ? 1 : 0);
}

void curved_hinges_case(KernelCase& c) {
    const int entries = kRow * c.items;
    auto& positions = add_points(c, "positions", 20);
    auto& slices = add_slices(c);
    auto& corners = add_indices(c, "corners", 4 * entries, 20);
    auto& weights = add_reals(c, "weights", 7 * entries, -1.0f, 1.0f);
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -1.0f, 1.0f);
    c.launch =
        launch(kernels::couple_curved_hinges, c.segments, positions, slices, corners, weights,
               blocks, c.items, entries, columns_of(c), c.items, c.items % 3 == 0 ? 1 : 0);
}

/// In degenerate cases directions are the same everywhere, as those of a translation.
Buffer<float4>& add_directions(KernelCase& c) {
    auto& directions = c.add<float4>("directions", c.items);
    for (float4& p : directions.span()) {
        p = c.flavour == Flavour::kRandom ? c.random.point(1.0f) : float4{1.0f, -2.0f, 3.0f, 0.0f};
    }
    return directions;
}

template <class Kernel>
void multiply_case(KernelCase& c, Kernel kernel, int columns) {
    const int entries = kRow * c.items;
    auto& directions = add_directions(c);
    auto& slices = add_slices(c);
    auto& others = add_indices(c, "others", entries, c.items);
    auto& blocks = add_reals(c, "blocks", columns * entries, -1.0f, 1.0f);
    auto& products = add_reals(c, "products", 3 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernel, c.segments, directions, slices, others, blocks, products, c.items,
                      entries, c.items, c.items % 2);
}

void multiply_any_case(KernelCase& c) { multiply_case(c, kernels::multiply_blocks, 9); }
void multiply_symmetric_case(KernelCase& c) {
    multiply_case(c, kernels::multiply_symmetric_blocks, 6);
}
void multiply_scalar_case(KernelCase& c) {
    const int entries = kRow * c.items;
    auto& directions = add_directions(c);
    auto& slices = add_slices(c);
    auto& others = add_indices(c, "others", entries, c.items);
    auto& blocks = add_reals(c, "blocks", entries, -1.0f, 1.0f);
    auto& products = add_reals(c, "products", 3 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::multiply_scalar_blocks, c.segments, directions, slices, others,
                      blocks, products, c.items, c.items, c.items % 2);
}

/// Of some vertices along a normal, of some in all directions.
Buffer<float4>& add_holds(KernelCase& c) {
    auto& holds = c.add<float4>("holds", c.items);
    for (float4& hold : holds.span()) {
        const auto degree = static_cast<float>(c.random.integer(0, 2));
        hold = {0.6f, 0.0f, -0.8f, degree};
        if (degree == 0.0f) hold = {};
    }
    return holds;
}

void begin_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    for (int i = 0; i < c.items; ++i) {
        for (const int diagonal : {3, 6, 8}) {
            sums[at(i + diagonal * c.items)] = c.flavour == Flavour::kRandom ? 3.0f : 0.0f;
        }
    }
    auto& holds = add_holds(c);
    auto& factors = add_reals(c, "factors", 6 * c.items, 1.0f, 2.0f);
    auto& residuals = c.add<float4>("residuals", c.items);
    for (float4& r : residuals.span()) r = {7.0f, 7.0f, 7.0f, 7.0f};
    auto& searches = add_reals(c, "searches", 3 * c.items, 1.0f, 2.0f);
    auto& applied = add_reals(c, "applied", 3 * c.items, 1.0f, 2.0f);
    auto& moves = add_reals(c, "moves", 3 * c.items, 1.0f, 2.0f);
    c.launch =
        launch(kernels::begin_conjugate_gradients, c.segments, positions, targets, sums, holds,
               factors, residuals, searches, applied, moves, c.items, c.random.integer(0, 1), 1e2f);
}

void precondition_case(KernelCase& c) {
    auto& residuals = add_points(c, "residuals", c.items);
    auto& factors = add_reals(c, "factors", 6 * c.items, -1.0f, 1.0f);
    auto& corrections = add_points(c, "corrections", 5);
    auto& aggregates = add_indices(c, "aggregates", c.items, 5);
    auto& holds = add_holds(c);
    auto& preconditioned = c.add<float4>("preconditioned", c.items);
    for (float4& u : preconditioned.span()) u = {7.0f, 7.0f, 7.0f, 7.0f};
    c.launch = launch(kernels::precondition, c.segments, residuals, factors, corrections,
                      aggregates, holds, preconditioned, c.items, c.random.integer(0, 1));
}

void finish_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& residuals = add_points(c, "residuals", c.items);
    auto& preconditioned = add_points(c, "preconditioned", c.items);
    auto& holds = add_holds(c);
    auto& products = add_reals(c, "products", 3 * c.items, -1.0f, 1.0f);
    auto& places = c.add<int>("places", c.items);
    for (int i = 0; i < c.items; ++i) places[at(i)] = i + 3;
    auto& terms = add_reals(c, "terms", 2 * c.items + 10, 1.0f, 2.0f);
    c.launch =
        launch(kernels::finish_product, c.segments, positions, residuals, preconditioned, holds,
               products, places, terms, c.items, c.items + 5, c.random.integer(0, 1), 1e2f);
}

void dot_columns_case(KernelCase& c) {
    auto& columns = add_reals(c, "columns", 2 * WEFT_DOT_COLUMNS * c.items, -1.0f, 1.0f);
    auto& first = c.add<int>("first", c.items);
    for (int i = 0; i < c.items; ++i) first[at(i)] = 2 * WEFT_DOT_COLUMNS * (c.items - 1 - i);
    auto& gammas = add_reals(c, "gammas", c.items, 10.0f, 20.0f);
    auto& deltas = add_reals(c, "deltas", c.items, 30.0f, 40.0f);
    c.launch = launch(kernels::add_dot_columns, c.segments, columns, first, gammas, deltas);
}

Buffer<float4>& add_scalars(KernelCase& c, int count) {
    auto& scalars = c.add<float4>("scalars", count);
    for (int i = 0; i < count; ++i) {
        const float gamma = i % 3 == 0 ? 0.0f : (i % 3 == 1 ? -1.0f : 2.0f);
        scalars[at(i)] = {gamma > 0.0f ? 0.5f : 0.0f, gamma, 1.5f, 0.3f};
    }
    return scalars;
}

void begin_steps_case(KernelCase& c) {
    auto& scalars = c.add<float4>("scalars", c.items);
    for (float4& s : scalars.span()) s = {1.0f, 1.0f, 1.0f, 1.0f};
    c.launch = launch(kernels::begin_steps, c.segments, scalars);
}

/// Degenerate: nothing left to do, or no curvature.
void find_step_case(KernelCase& c) {
    constexpr int kStrips = 40;
    const bool is_random = c.flavour == Flavour::kRandom;
    auto& gammas =
        add_reals(c, "gammas", kStrips, 0.0f, is_random || c.items % 2 == 0 ? 1.0f : 0.0f);
    auto& deltas =
        add_reals(c, "deltas", kStrips, is_random ? 2.0f : 0.0f, is_random ? 9.0f : 0.0f);
    auto& scalars = add_scalars(c, c.items);
    c.launch = launch(kernels::find_step, c.segments, gammas, deltas, scalars, kStrips);
}

void take_step_case(KernelCase& c) {
    auto& scalars = add_scalars(c, 6);
    auto& strips = add_indices(c, "strips", c.items, 6);
    auto& preconditioned = add_points(c, "preconditioned", c.items);
    auto& products = add_reals(c, "products", 3 * c.items, -1.0f, 1.0f);
    auto& searches = add_reals(c, "searches", 3 * c.items, -1.0f, 1.0f);
    auto& applied = add_reals(c, "applied", 3 * c.items, -1.0f, 1.0f);
    auto& moves = add_reals(c, "moves", 3 * c.items, -1.0f, 1.0f);
    auto& residuals = add_points(c, "residuals", c.items);
    c.launch = launch(kernels::take_step, c.segments, scalars, strips, preconditioned, products,
                      searches, applied, moves, residuals, c.items);
}

void restrict_case(KernelCase& c) {
    auto& residuals = add_points(c, "residuals", 30);
    auto& members = add_indices(c, "members", kRow * c.items, 30);
    auto& shares = c.add<float>("shares", kRow * c.items);
    for (float& share : shares.span()) share = c.random.integer(0, 3) == 0 ? 0.0f : 1.0f;
    auto& slices = add_slices(c);
    auto& restricted = c.add<float4>("restricted", c.items);
    for (float4& r : restricted.span()) r = {7.0f, 7.0f, 7.0f, 7.0f};
    c.launch = launch(kernels::restrict_residuals, c.segments, residuals, members, shares, slices,
                      restricted, c.items);
}

/// A chain of aggregates, the first one tied to what is held. Degenerate: nothing at all.
void factor_case(KernelCase& c) {
    const float size = c.flavour == Flavour::kRandom ? 1.0f : 0.0f;
    constexpr int kReach = 13;
    constexpr int kWidth = 3 * kReach + 2;
    auto& pairs = c.add<int>("pairs", 2 * c.items);
    for (int a = 0; a < c.items; ++a) {
        pairs[at(2 * a)] = a;
        pairs[at(2 * a + 1)] = std::max(a - kReach, 0);
    }
    auto& blocks = add_reals(c, "blocks", 9 * c.items, -0.1f * size, 0.1f * size);
    for (int a = 0; a < c.items; ++a) {
        for (const int diagonal : {0, 3, 5}) blocks[at(a + diagonal * c.items)] = size;
    }
    auto& inertia = add_reals(c, "inertia", c.items, 0.0f, size);
    auto& band = add_reals(c, "band", 3 * c.items * (kWidth + 1), 2.0f, 3.0f);
    c.launch = launch(kernels::factor_coarse, c.segments, pairs, blocks, inertia, band, c.items,
                      c.items, kWidth);
}

void invert_case(KernelCase& c) {
    constexpr int kWidth = 4;
    auto& band = add_reals(c, "band", 3 * c.items * (kWidth + 1), -0.15f, 0.15f);
    for (int r = 0; r < 3 * c.items; ++r) band[at(r * (kWidth + 1) + kWidth)] = 1.0f;
    auto& numbers = c.add<float>("numbers", c.items);
    auto& places = c.add<int>("places", c.items);
    for (int i = 0; i < c.items; ++i) {
        numbers[at(i)] = static_cast<float>(i);
        places[at(i)] = i;
    }
    auto& inverse = add_reals(c, "inverse", 9 * c.items * c.items, 2.0f, 3.0f);
    c.launch = launch(kernels::invert_coarse, c.segments, band, numbers, places, inverse, c.items,
                      kWidth, c.items);
}

void correct_case(KernelCase& c) {
    auto& restricted = add_points(c, "restricted", c.items);
    auto& inverse = add_reals(c, "inverse", 9 * c.items * c.items, -1.0f, 1.0f);
    auto& places = c.add<int>("places", c.items);
    for (int i = 0; i < c.items; ++i) places[at(i)] = i;
    auto& corrections = c.add<float4>("corrections", c.items + 1);
    for (float4& z : corrections.span()) z = {7.0f, 7.0f, 7.0f, 7.0f};
    c.launch = launch(kernels::correct_coarse, c.segments, restricted, inverse, places, corrections,
                      c.items, c.items);
}

Buffer<float>& add_control(KernelCase& c) {
    auto& control = c.add<float>("control", WEFT_CONTROL_SIZE);
    control[WEFT_STEP_SIZE] = c.items % 3 == 0 ? 0.25f : 1.0f;
    control[WEFT_ENERGY] = c.random.real(0.0f, 1.0f);
    return control;
}

void move_case(KernelCase& c) {
    auto& before = add_points(c, "before", c.items);
    auto& moves = add_reals(c, "moves", 3 * c.items, -1.0f, 1.0f);
    auto& control = add_control(c);
    auto& positions = c.add<float4>("positions", c.items);
    for (float4& x : positions.span()) x = {7.0f, 7.0f, 7.0f, -7.0f};
    c.launch =
        launch(kernels::move_by_solution, c.segments, before, moves, control, positions, c.items);
}

void sum_rows_case(KernelCase& c) {
    const int columns = c.items % 3 == 0 ? 1 : 6;
    auto& slices = add_slices(c);
    auto& blocks = add_reals(c, "blocks", 6 * kRow * c.items, -1.0f, 1.0f);
    auto& sums = add_reals(c, "sums", 9 * c.items, -1.0f, 1.0f);
    c.launch = launch(kernels::sum_block_rows, c.segments, slices, blocks, sums, c.items,
                      kRow * c.items, columns, c.items, c.items % 2);
}

void decide_case(KernelCase& c) {
    auto& control = add_control(c);
    auto& partials = add_reals(c, "partials", 100, 0.0f, 0.01f);
    c.launch =
        launch(kernels::decide_newton, c.segments, control, partials, 100, 1.5f, c.items % 3);
}

const bool added =
    add_case("couple_membranes", membranes_case) && add_case("couple_woven", woven_case) &&
    add_case("block_tetrahedra", tetrahedra_case) &&
    add_case("sum_element_blocks", element_blocks_case) &&
    add_case("couple_springs", springs_case) && add_case("couple_stitches", stitches_case) &&
    add_case("couple_hinges", hinges_case) &&
    add_case("couple_curved_hinges", curved_hinges_case) &&
    add_case("multiply_blocks", multiply_any_case) &&
    add_case("multiply_symmetric_blocks", multiply_symmetric_case) &&
    add_case("multiply_scalar_blocks", multiply_scalar_case) &&
    add_case("begin_conjugate_gradients", begin_case) &&
    add_case("precondition", precondition_case) && add_case("finish_product", finish_case) &&
    add_case("add_dot_columns", dot_columns_case) && add_case("begin_steps", begin_steps_case) &&
    add_case("find_step", find_step_case) && add_case("take_step", take_step_case) &&
    add_case("restrict_residuals", restrict_case) && add_case("factor_coarse", factor_case) &&
    add_case("invert_coarse", invert_case) && add_case("correct_coarse", correct_case) &&
    add_case("move_by_solution", move_case) && add_case("sum_block_rows", sum_rows_case) &&
    add_case("decide_newton", decide_case);

}  // namespace
}  // namespace weft::test
