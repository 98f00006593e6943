#include "kernels/descent/free_bodies.h"
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

void lags_case(KernelCase& c) {
    const int entries = c.items + (kRows - 1) * WEFT_RUN_COLUMNS;
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& members = add_indices(c, "members", entries, c.items);
    auto& shares = c.add<float>("shares", entries);
    for (float& share : shares.span()) share = c.random.real(0.0f, 1.0f);
    auto& rows = c.add<int>("rows", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = kRows;
    }
    auto& partials = c.add<float4>("partials", c.items);
    c.launch =
        launch(kernels::add_lags, c.segments, positions, targets, members, shares, rows, partials);
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

void runs_case(KernelCase& c) {
    auto& lags = add_points(c, "lags", c.items + kRows);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = c.add<float>("counts", c.items);
    for (float& count : counts.span()) count = static_cast<float>(c.random.integer(0, kRows));
    auto& shifts = c.add<float4>("shifts", c.items);
    c.launch = launch(kernels::add_runs, c.segments, lags, first, counts, shifts, kRows);
}

void shift_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& deviations = add_points(c, "deviations", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    auto& shifts = add_points(c, "shifts", 4);
    auto& runs = add_indices(c, "runs", c.items, 4);
    c.launch = launch(kernels::shift_bodies, c.segments, positions, deviations, velocities, shifts,
                      runs, 240.0f);
}

void push_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& pushed = add_points(c, "pushed", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    c.launch = launch(kernels::push_velocities, c.segments, positions, pushed, velocities, 240.0f);
}

const bool added = add_case("add_lags", lags_case) && add_case("add_columns", columns_case) &&
                   add_case("add_runs", runs_case) && add_case("shift_bodies", shift_case) &&
                   add_case("push_velocities", push_case);

}  // namespace
}  // namespace weft::test
