#include "kernels/bodies/free_bodies.h"
#include "tests/kernels/held_point.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr int kRows = 3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (float4& x : points.span()) {
        x = c.random.point(c.flavour == Flavour::kRandom ? 1.0f : 0.0f);
        x.w = c.random.real(0.5f, 1.0f);
    }
    return points;
}

Buffer<int>& add_indices(KernelCase& c, const std::string& name, int count, int end) {
    auto& indices = c.add<int>(name, count);
    for (int& index : indices.span()) index = c.random.integer(0, end - 1);
    return indices;
}

void columns_case(KernelCase& c) {
    const int columns = c.items + WEFT_RUN_COLUMNS;
    auto& partials = add_points(c, "partials", columns);
    auto& starts = add_indices(c, "starts", c.items, c.items);
    auto& places = c.add<int>("places", c.items);
    for (int i = 0; i < c.items; ++i) places[at(i)] = c.items - 1 - i;
    auto& lags = c.add<float4>("lags", c.items);
    c.launch = launch(kernels::add_columns, c.segments, partials, starts, places, lags);
}

/// What runs have of bodies that are spread out, or lie in a point, all of them around it.
Buffer<float4>& add_sums(KernelCase& c, int runs) {
    auto& sums = add_points(c, "sums", WEFT_MOMENT_PARTS * runs);
    const bool is_point = c.flavour == Flavour::kDegenerate;
    for (int r = 0; r < runs; ++r) {
        float4* parts = sums.data() + WEFT_MOMENT_PARTS * r;
        const auto spread = [&] { return is_point ? 0.0f : c.random.real(4.0f, 8.0f); };
        parts[0].w = spread();
        parts[1].z = spread();
        parts[2].w = spread();
        hold_a_point(c, parts, 1);
        if (is_point) parts[8] = parts[9] = parts[10] = {};
        if (!is_point) parts[1].x = parts[1].y = parts[1].w = c.random.real(-1.0f, 1.0f);
    }
    return sums;
}

void solve_case(KernelCase& c) {
    auto& sums = add_sums(c, c.items + kRows);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = c.add<float>("counts", c.items);
    for (float& count : counts.span()) count = static_cast<float>(c.random.integer(0, kRows));
    auto& motions = c.add<float4>("motions", 3 * (c.items + 1));
    c.launch =
        launch(kernels::solve_runs, c.segments, sums, first, counts, motions, kRows, c.items);
}

void move_case(KernelCase& c) {
    constexpr int kRuns = 3;
    auto& positions = add_points(c, "positions", c.items);
    auto& deviations = add_points(c, "deviations", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    auto& motions = add_points(c, "motions", 3 * (kRuns + 1));
    auto& runs = add_indices(c, "runs", c.items, kRuns + 1);
    c.launch = launch(kernels::move_runs, c.segments, positions, deviations, velocities, motions,
                      runs, 240.0f, kRuns);
}

void push_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& pushed = add_points(c, "pushed", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    c.launch = launch(kernels::push_velocities, c.segments, positions, pushed, velocities, 240.0f);
}

const bool added = add_case("add_columns", columns_case) && add_case("solve_runs", solve_case) &&
                   add_case("move_runs", move_case) && add_case("push_velocities", push_case);

}  // namespace
}  // namespace weft::test
