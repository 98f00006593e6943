#include <algorithm>

#include "kernels/bodies/free_bodies.h"
#include "kernels/bodies/held_bodies.h"
#include "kernels/bodies/starts.h"
#include "kernels/bodies/ties.h"
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
    c.launch = launch(kernels::solve_runs, c.segments, sums, first, counts, motions, kRows, c.items,
                      c.random.integer(0, 1) == 0 ? 0.0f : 50.0f);
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

constexpr int kParts = 3;

/// A column for each item, of two rows.
void pull_case(KernelCase& c) {
    const int entries = c.items + WEFT_RUN_COLUMNS;
    auto& positions = add_points(c, "positions", c.items);
    auto& ends = add_indices(c, "ends", 2 * entries, c.items);
    auto& parts = add_indices(c, "parts", 2 * entries, kParts + 1);
    auto& springs = c.add<float>("springs", 4 * entries);
    for (float& value : springs.span()) value = c.random.real(0.1f, 2.0f);
    auto& rows = c.add<int>("rows", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = 2;
    }
    auto& motions = add_points(c, "motions", 3 * (kParts + 1));
    auto& clock = c.add<float>("clock", 2);
    clock[0] = 0.25f;
    clock[1] = 1.5f;
    auto& partials = c.add<float4>("partials", WEFT_TIE_PARTS * c.items);
    c.launch = launch(kernels::pull_parts, c.segments, positions, ends, parts, springs, rows,
                      motions, clock, partials, entries, kParts, c.items, kInstance);
}

Buffer<int>& add_numbers(KernelCase& c) {
    auto& numbers = c.add<int>("numbers", c.items);
    for (int i = 0; i < c.items; ++i) numbers[at(i)] = i;
    return numbers;
}

void start_parts_case(KernelCase& c) {
    auto& sums = add_sums(c, c.items + 1);
    auto& numbers = add_numbers(c);
    auto& motions = add_points(c, "motions", 3 * (c.items + 1));
    c.launch = launch(kernels::start_parts, c.segments, sums, numbers, motions, c.items);
}

/// Ties in points near the part, or none.
void step_parts_case(KernelCase& c) {
    const int columns = WEFT_RUN_COLUMNS * c.items;
    auto& sums = add_sums(c, c.items + 1);
    auto& numbers = add_numbers(c);
    auto& partials = c.add<float4>("partials", WEFT_TIE_PARTS * columns);
    for (int k = 0; k < columns; ++k) {
        const float4 pull = c.random.point(0.01f);
        const float4 r = c.random.point(1.0f);
        const float stiffness = c.random.integer(0, 3) == 0 ? c.random.real(0.0f, 0.5f) : 0.0f;
        const auto row = [&](int n) -> float4& { return partials[at(n * columns + k)]; };
        row(0) = {pull.x, pull.y, pull.z, stiffness * r.x * r.x};
        row(1) = {pull.y, pull.z, pull.x, stiffness * r.x * r.y};
        row(2) = {stiffness * r.x, stiffness * r.y, stiffness * r.z, stiffness};
        row(3) = {stiffness * r.y * r.y, stiffness * r.y * r.z, stiffness * r.z * r.z,
                  stiffness * r.x * r.z};
    }
    auto& motions = add_points(c, "motions", 3 * (c.items + 1));
    c.launch =
        launch(kernels::step_parts, c.segments, sums, numbers, partials, motions, c.items, columns);
}

void move_parts_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& vertices = c.add<int>("vertices", c.items);
    for (int i = 0; i < c.items; ++i) vertices[at(i)] = c.items - 1 - i;
    auto& parts = add_indices(c, "parts", c.items, kParts);
    auto& motions = add_points(c, "motions", 3 * (kParts + 1));
    c.launch = launch(kernels::move_parts, c.segments, positions, vertices, parts, motions, kParts);
}

/// Rows of up to three contacts, with the own body and others.
void see_held_case(KernelCase& c) {
    constexpr int kLongest = 3;
    const int entries = WEFT_ROW_STRIDE * kLongest + c.items;
    auto& targets = add_points(c, "targets", c.items);
    auto& starts = add_points(c, "starts", c.items);
    for (int v = 0; v < c.items; v += 3) starts[at(v)] = targets[at(v)];
    auto& bodies = c.add<float>("bodies", c.items);
    for (int v = 0; v < c.items; ++v) bodies[at(v)] = v < 2 * c.items / 3 ? 0.0f : 1.0f;
    auto& rows = c.add<int>("rows", c.items);
    auto& counts = add_indices(c, "counts", c.items, kLongest + 1);
    for (int v = 0; v < c.items; ++v) rows[at(v)] = v;
    std::vector<Buffer<int>*> corners;
    for (const std::string name : {"corner0", "corner1", "corner2", "corner3"})
        corners.push_back(&add_indices(c, name, entries, c.items));
    auto& seen = c.add<float4>("seen", c.items);
    c.launch =
        launch(kernels::see_held, c.segments, targets, starts, bodies, rows, counts, *corners[0],
               *corners[1], *corners[2], *corners[3], seen, c.random.integer(0, 1));
}

void hinges_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& ends = add_indices(c, "ends", 2 * c.items, c.items);
    auto& hinges = c.add<float4>("hinges", 2 * c.items);
    c.launch = launch(kernels::find_hinges, c.segments, positions, ends, hinges, c.items);
}

/// A column for each item, of two rows.
void pulls_case(KernelCase& c) {
    constexpr int kHeld = 5;
    const int entries = c.items + WEFT_RUN_COLUMNS;
    auto& positions = add_points(c, "positions", c.items);
    auto& now = add_points(c, "now", c.items);
    auto& vertices = add_indices(c, "vertices", kHeld, c.items);
    auto& sums = c.add<float>("sums", 9 * kHeld);
    for (float& value : sums.span()) value = c.random.real(-1.0f, 1.0f);
    auto& members = add_indices(c, "members", entries, kHeld);
    auto& shares = c.add<float>("shares", entries);
    for (float& share : shares.span()) share = static_cast<float>(c.random.integer(0, 3));
    auto& rows = c.add<int>("rows", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = 2;
    }
    auto& origins = add_indices(c, "origins", c.items, c.items);
    auto& partials = c.add<float4>("partials", WEFT_PULL_PARTS * c.items);
    c.launch = launch(kernels::add_pulls, c.segments, positions, now, vertices, sums, members,
                      shares, rows, origins, partials, kHeld, c.items, c.random.integer(0, 1));
}

/// Of bodies held by two vertices, softly or hard, or by nothing.
Buffer<float4>& add_holds(KernelCase& c, int runs) {
    auto& pulls = c.add<float4>("pulls", WEFT_PULL_PARTS * runs);
    for (int r = 0; r < runs; ++r) {
        kernels::hold h = kernels::no_hold();
        for (int k = c.random.integer(0, 2); k > 0; --k) {
            const float4 p = c.random.point(1.0f), way = c.random.point(1.0f);
            const kernels::real3 line = {way.x, way.y, way.z};
            const float hard = c.random.integer(0, 1) == 0 ? 1.0f : 1e5f;
            const kernels::sym3 block = kernels::outer_sym(line, hard);
            h.pull = kernels::add_scaled_motion(h.pull, {line, {p.x, p.y, p.z}}, 0.1f);
            h.form = kernels::add_scaled_sym6(h.form,
                                              kernels::form_at_lever(block, {p.x, p.y, p.z}), 1.0f);
        }
        kernels::store_hold(pulls.data() + WEFT_PULL_PARTS * r, 1, {0, 1}, h);
    }
    return pulls;
}

Buffer<float>& add_run_counts(KernelCase& c) {
    auto& counts = c.add<float>("counts", c.items);
    for (float& count : counts.span()) count = static_cast<float>(c.random.integer(1, kRows));
    return counts;
}

Buffer<float>& add_run_numbers(KernelCase& c) {
    auto& numbers = c.add<float>("numbers", 3 * c.items);
    for (int r = 0; r < c.items; ++r) {
        numbers[at(r)] = c.random.real(0.1f, 1.0f);
        numbers[at(2 * c.items + r)] = c.random.real(0.01f, 1.0f);
        numbers[at(c.items + r)] = static_cast<float>(c.random.integer(0, 1));
    }
    return numbers;
}

Buffer<float>& add_margins(KernelCase& c) {
    auto& margins = c.add<float>("margins", c.items);
    for (float& margin : margins.span())
        margin = 0.1f * static_cast<float>(c.random.integer(-1, 1));
    return margins;
}

void solve_held_case(KernelCase& c) {
    const int runs = c.items + kRows;
    auto& sums = add_sums(c, runs);
    auto& pulls = add_holds(c, runs);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = add_run_counts(c);
    auto& hinges = add_points(c, "hinges", 2 * c.items);
    auto& numbers = add_run_numbers(c);
    auto& motions = c.add<float4>("motions", 3 * (c.items + 1));
    c.launch = launch(kernels::solve_held, c.segments, sums, pulls, first, counts, hinges, numbers,
                      motions, kRows, c.items, 50.0f);
}

void carries_case(KernelCase& c) {
    auto& before = add_points(c, "before", c.items);
    auto& now = add_points(c, "now", c.items);
    for (int v = 0; v < c.items; ++v) now[at(v)].w *= static_cast<float>(v % 3 == 0);
    auto& ends = add_indices(c, "ends", c.items, c.items);
    auto& carries = c.add<float4>("carries", c.items);
    c.launch = launch(kernels::find_carries, c.segments, before, now, ends, carries);
}

void solve_starts_case(KernelCase& c) {
    const int runs = c.items + kRows;
    auto& sums = add_sums(c, runs);
    auto& pulls = add_holds(c, runs);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = add_run_counts(c);
    auto& hinges = add_points(c, "hinges", 2 * c.items);
    auto& carries = add_points(c, "carries", c.items);
    auto& numbers = add_run_numbers(c);
    auto& margins = add_margins(c);
    auto& motions = c.add<float4>("motions", 3 * (c.items + 1));
    c.launch = launch(kernels::solve_starts, c.segments, sums, pulls, first, counts, hinges,
                      carries, numbers, margins, motions, kRows, c.items);
}

constexpr int kStartRuns = 3;

/// Of three runs, with vertices before and behind them and between two.
Buffer<int>& add_bounds(KernelCase& c) {
    auto& bounds = c.add<int>("bounds", 2 * kStartRuns);
    const int part = c.items / 5;
    for (int r = 0; r < kStartRuns; ++r) {
        bounds[at(r)] = 1 + part * r;
        bounds[at(kStartRuns + r)] = 1 + part * (r + 1) - (r == 1 && part > 1 ? 1 : 0);
    }
    return bounds;
}

void weigh_starts_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    for (int v = 0; v < c.items; v += 4) positions[at(v)].w = 0.0f;
    auto& previous = add_points(c, "previous", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& motions = add_points(c, "motions", 3 * (kStartRuns + 1));
    auto& carries = add_points(c, "carries", kStartRuns + 1);
    auto& bounds = add_bounds(c);
    auto& vertices = c.add<int>("vertices", c.items);
    for (int i = 0; i < c.items; ++i) vertices[at(i)] = c.items - 1 - i;
    auto& sums = c.add<float>("sums", 9 * c.items);
    for (float& value : sums.span()) value = c.random.real(-1.0f, 1.0f);
    auto& rises = c.add<float>("rises", c.items);
    c.launch = launch(kernels::weigh_starts, c.segments, positions, previous, targets, motions,
                      carries, bounds, vertices, sums, rises, c.items, 1e3f, kStartRuns);
}

/// A column for each item, of two rows.
void rises_case(KernelCase& c) {
    const int entries = c.items + WEFT_RUN_COLUMNS;
    auto& rises = c.add<float>("rises", c.items);
    for (float& rise : rises.span()) rise = c.random.real(-1.0f, 1.0f);
    auto& members = add_indices(c, "members", entries, c.items);
    auto& shares = c.add<float>("shares", entries);
    for (float& share : shares.span()) share = static_cast<float>(c.random.integer(0, 1));
    auto& rows = c.add<int>("rows", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = 2;
    }
    auto& partials = c.add<float4>("partials", c.items);
    c.launch = launch(kernels::add_rises, c.segments, rises, members, shares, rows, partials);
}

void choose_starts_case(KernelCase& c) {
    auto& rises = add_points(c, "rises", c.items + kRows);
    for (float4& rise : rises.span()) rise.x += c.random.real(-0.5f, 0.5f);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = add_run_counts(c);
    auto& margins = add_margins(c);
    auto& touched = c.add<float>("touched", c.items);
    for (float& share : touched.span())
        share = 0.1f * static_cast<float>(std::max(c.random.integer(-2, 1), 0));
    auto& chosen = c.add<float>("chosen", c.items + 1);
    c.launch = launch(kernels::choose_starts, c.segments, rises, first, counts, margins, touched,
                      chosen, kRows, c.random.integer(0, 1));
}

/// The same, of runs of which all are led: a pack has columns of one run alone.
void start_moved_case(KernelCase& c) {
    const int vertices = c.items + WEFT_RUN_COLUMNS;
    auto& positions = add_points(c, "positions", vertices);
    auto& previous = add_points(c, "previous", vertices);
    auto& motions = add_points(c, "motions", 3 * (kStartRuns + 1));
    auto& chosen = c.add<float>("chosen", kStartRuns);
    for (float& start : chosen.span()) start = 1.0f;
    auto& members = c.add<int>("members", vertices);
    for (int e = 0; e < vertices; ++e) members[at(e)] = vertices - 1 - e;
    auto& shares = c.add<float>("shares", vertices);
    for (float& share : shares.span()) share = static_cast<float>(c.random.integer(0, 1));
    auto& rows = c.add<int>("rows", 2 * c.items);
    auto& runs = c.add<int>("runs", c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = c.items <= WEFT_RUN_COLUMNS ? 2 : 1;
        runs[at(i)] = i / WEFT_RUN_COLUMNS % kStartRuns;
    }
    c.launch = launch(kernels::start_moved, c.segments, positions, previous, motions, chosen,
                      members, shares, rows, runs, kStartRuns);
}

void touched_case(KernelCase& c) {
    auto& sums = add_sums(c, c.items + kRows);
    auto& first = add_indices(c, "first_run", c.items, c.items);
    auto& counts = add_run_counts(c);
    auto& touched = c.add<float>("touched", c.items);
    c.launch = launch(kernels::keep_touched, c.segments, sums, first, counts, touched, kRows);
}

/// A column for each item, of two rows, over vertices of their own.
void move_held_case(KernelCase& c) {
    constexpr int kRuns = 3;
    const int vertices = c.items + WEFT_RUN_COLUMNS;
    auto& positions = add_points(c, "positions", vertices);
    auto& deviations = add_points(c, "deviations", vertices);
    auto& velocities = add_points(c, "velocities", vertices);
    auto& motions = add_points(c, "motions", 3 * (kRuns + 1));
    auto& members = c.add<int>("members", vertices);
    for (int e = 0; e < vertices; ++e) members[at(e)] = vertices - 1 - e;
    auto& shares = c.add<float>("shares", vertices);
    for (float& share : shares.span()) share = static_cast<float>(c.random.integer(0, 1));
    auto& rows = c.add<int>("rows", 2 * c.items);
    for (int i = 0; i < c.items; ++i) {
        rows[at(2 * i)] = i;
        rows[at(2 * i + 1)] = c.items <= WEFT_RUN_COLUMNS ? 2 : 1;
    }
    auto& runs = add_indices(c, "runs", c.items, kRuns);
    c.launch = launch(kernels::move_held, c.segments, positions, deviations, velocities, motions,
                      members, shares, rows, runs, 240.0f, kRuns);
}

const bool added =
    add_case("add_columns", columns_case) && add_case("solve_runs", solve_case) &&
    add_case("move_runs", move_case) && add_case("push_velocities", push_case) &&
    add_case("start_parts", start_parts_case) && add_case("pull_parts", pull_case) &&
    add_case("step_parts", step_parts_case) && add_case("move_parts", move_parts_case) &&
    add_case("see_held", see_held_case) && add_case("find_hinges", hinges_case) &&
    add_case("add_pulls", pulls_case) && add_case("solve_held", solve_held_case) &&
    add_case("move_held", move_held_case) && add_case("find_carries", carries_case) &&
    add_case("solve_starts", solve_starts_case) && add_case("weigh_starts", weigh_starts_case) &&
    add_case("add_rises", rises_case) && add_case("choose_starts", choose_starts_case) &&
    add_case("start_moved", start_moved_case) && add_case("keep_touched", touched_case);

}  // namespace
}  // namespace weft::test
