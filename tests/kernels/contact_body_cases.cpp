#include "kernels/contact/groups.h"
#include "kernels/contact/pushes.h"
#include "kernels/contact/stops.h"
#include "kernels/contact/strains.h"
#include "tests/kernels/contact_response_parts.h"

namespace weft::test {
namespace {

using namespace response;

/// Where columns begin, and what is summed in them.
struct Columns {
    static constexpr int kRows = 3;
    Buffer<int>&members, &rows;
    Buffer<float>& shares;

    explicit Columns(KernelCase& c)
        : members(add_indices(c, "members", entries(c), c.items)),
          rows(c.add<int>("column_rows", 2 * c.items)),
          shares(c.add<float>("shares", entries(c))) {
        for (int i = 0; i < c.items; ++i) {
            rows[at(2 * i)] = i;
            rows[at(2 * i + 1)] = kRows;
        }
        for (float& share : shares.span()) share = std::max(c.random.real(-0.2f, 1.0f), 0.0f);
    }
    static int entries(KernelCase& c) { return c.items + (kRows - 1) * WEFT_RUN_COLUMNS; }
};

constexpr int kLevels = 3;  ///< of groups
constexpr int kTables = kSubsteps * kLevels;

int random_level(KernelCase& c) { return c.random.integer(0, kLevels - 1); }

/// What a body has of contacts, as collect_pushes leaves it.
struct Pushes {
    Rows rows;
    Buffer<int>& codes;
    Buffer<float4>&sides, &slips, &forces, &points, &other_points;
    Buffer<float>& presses;
    Buffer<float4>& standing;

    explicit Pushes(KernelCase& c)
        : rows(c, "pushes", c.items, kRoom),
          codes(add_indices(c, "codes", rows.entries, (kBodies + 1) << WEFT_LEVEL_BITS)),
          sides(add_normals(c, "sides", rows.entries, -kRange, 2.0f * kRange)),
          slips(add_points(c, "slips", rows.entries)),
          forces(c.add<float4>("forces", rows.entries)),
          points(add_points(c, "points", rows.entries)),
          other_points(add_points(c, "other_points", rows.entries)),
          presses(c.add<float>("presses", rows.entries)),
          standing(add_points(c, "standing", c.items)) {
        for (float& press : presses.span()) press = c.random.real(0.0f, 10.0f);
        for (float4& f : forces.span()) f = {1.0f, 2.0f, c.random.real(1.0f, 1e4f), kRange};
        for (float4& p : points.span()) p.w = c.random.integer(0, 2) == 0 ? 0.3f : WEFT_RESTS_NOT;
    }
};

void collect_case(KernelCase& c) {
    auto& targets = add_points(c, "targets", c.items);
    Columns columns(c);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies + 1);
    auto& leaders = add_indices(c, "leaders", kTables * kBodies, kBodies);
    OwnContacts contacts(c);
    for (float4& m : contacts.measures.span()) m.x += 0.5f;
    auto& multipliers = c.add<float>("multipliers", contacts.rows.entries);
    for (float& multiplier : multipliers.span()) multiplier = c.random.real(0.0f, 1e-3f);
    Pushes pushes(c);
    auto& needs = add_indices(c, "push_needs", c.items, 9);
    c.launch = launch(
        kernels::collect_pushes, c.segments, contacts.positions, targets, columns.members,
        columns.shares, columns.rows, bodies, leaders, contacts.rows.rows, contacts.rows.counts,
        contacts.corner0, contacts.corner1, contacts.corner2, contacts.corner3, contacts.normals,
        contacts.weights, contacts.measures, contacts.slips, multipliers, pushes.rows.rows,
        pushes.rows.counts, needs, pushes.codes, pushes.sides, pushes.slips, pushes.forces,
        pushes.points, pushes.other_points, pushes.presses, pushes.standing, c.items, kBodies,
        kLevels, c.flavour == Flavour::kRandom ? 0.3f : 0.0f, c.random.integer(0, 1), 1e4f,
        kInstance);
}

void collect_none_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    Columns columns(c);
    auto& counts = c.add<int>("push_counts", c.items);
    auto& needs = c.add<int>("push_needs", c.items);
    for (int& need : needs.span()) need = c.random.integer(0, 9);
    auto& standing = c.add<float4>("standing", c.items);
    c.launch = launch(kernels::collect_no_pushes, c.segments, positions, targets, columns.members,
                      columns.shares, columns.rows, counts, needs, standing, kInstance);
}

void moments_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& previous = add_points(c, "previous", c.items);
    auto& starts = add_points(c, "starts", c.items);
    Columns columns(c);
    auto& origins = add_indices(c, "origins", c.items, c.items);
    auto& partials = c.add<float4>("partials", WEFT_MOMENT_PARTS * c.items);
    c.launch = launch(kernels::add_moments, c.segments, positions, targets, previous, starts,
                      columns.members, columns.shares, columns.rows, origins, partials,
                      c.random.integer(0, 1), c.items);
}

/// The runs of bodies.
struct Runs {
    static constexpr int kMost = 3;
    Buffer<int>& first;
    Buffer<float>& counts;

    explicit Runs(KernelCase& c)
        : first(add_indices(c, "first_run", c.items, c.items)),
          counts(c.add<float>("counts", c.items)) {
        for (float& count : counts.span()) count = static_cast<float>(c.random.integer(1, kMost));
    }
};

void weigh_case(KernelCase& c) {
    auto& sums = add_points(c, "sums", WEFT_MOMENT_PARTS * (c.items + Runs::kMost));
    Runs runs(c);
    auto& moments = c.add<float4>("moments", WEFT_MOMENT_PARTS * (c.items + 1));
    c.launch = launch(kernels::weigh_bodies, c.segments, sums, runs.first, runs.counts, moments,
                      Runs::kMost, c.items);
}

/// Some are spread along a line, or not at all.
Buffer<float4>& add_moments(KernelCase& c, int bodies) {
    const int rows = bodies + 1;
    auto& moments = add_points(c, "moments", WEFT_MOMENT_PARTS * rows);
    for (int b = 0; b < bodies; ++b) {
        const auto spread = [&] {
            const bool is_flat = c.flavour == Flavour::kDegenerate && c.random.integer(0, 1) == 0;
            return is_flat ? 0.0f : c.random.real(0.1f, 1.0f);
        };
        moments[at(b)].w = spread();
        moments[at(rows + b)] = {0.0f, 0.0f, spread(), 0.0f};
        moments[at(2 * rows + b)] = {0.0f, 0.0f, 0.0f, spread()};
    }
    return moments;
}

void lags_case(KernelCase& c) {
    auto& bodies = add_indices(c, "column_bodies", c.items, kBodies);
    auto& masses = c.add<float>("masses", kBodies);
    for (float& mass : masses.span()) mass = c.random.real(0.1f, 10.0f);
    auto& moments = add_moments(c, kBodies);
    auto& motions = add_points(c, "motions", 2 * (kBodies + 1));
    auto& strains = add_points(c, "strains", 2 * (kBodies + 1));
    auto& bearings = add_points(c, "bearings", WEFT_BEARING_PARTS * (kBodies + 1));
    Pushes pushes(c);
    auto& partials = c.add<float4>("partials", WEFT_RUBBED_BODY_PARTS * c.items);
    c.launch =
        launch(kernels::add_pushed_lags, c.segments, pushes.standing, bodies, masses, moments,
               motions, strains, bearings, pushes.rows.rows, pushes.rows.counts, pushes.codes,
               pushes.sides, pushes.slips, pushes.forces, pushes.points, pushes.other_points,
               pushes.presses, partials, c.flavour == Flavour::kRandom ? 0.3f : 0.0f, 0.02f, 1e-4f,
               c.random.integer(0, 1), c.random.integer(0, 1), c.random.integer(0, 1),
               c.random.integer(0, 1), random_level(c), c.items, kBodies);
}

/// Forms of motions of so many: semi-definite, five rows of each; some are zero.
void fill_forms(KernelCase& c, Buffer<float4>& forms, int rows, int first) {
    for (int k = 0; k < rows; ++k) {
        if (c.random.integer(0, 3) == 0) continue;
        const auto row = [&](int n) -> float4& { return forms[at((first + n) * rows + k)]; };
        const auto along = [&] { return c.random.real(0.5f, 2.0f); };
        const auto across = [&] { return c.random.real(-0.1f, 0.1f); };
        row(0) = {along(), across(), across(), along()};
        row(1) = {across(), along(), along(), across()};
        row(2) = {across(), along(), across(), along()};
        row(3) = {across(), across(), across(), across()};
        row(4) = {across(), across(), across(), across()};
    }
}

Buffer<float>& add_flags(KernelCase& c, const char* name, int bodies) {
    auto& flags = c.add<float>(name, bodies);
    for (float& flag : flags.span()) flag = static_cast<float>(c.random.integer(0, 1));
    return flags;
}

void bodies_case(KernelCase& c) {
    const int lag_count = c.items + Runs::kMost;
    auto& lags = c.add<float4>("lags", WEFT_RUBBED_BODY_PARTS * lag_count);
    fill_forms(c, lags, lag_count, 0);
    fill_forms(c, lags, lag_count, 7);
    for (int k = WEFT_BODY_PARTS * lag_count; k < WEFT_RUBBED_BODY_PARTS * lag_count; ++k)
        lags[at(k)] = c.random.point(0.1f);
    for (int k = 5 * lag_count; k < 7 * lag_count; ++k) lags[at(k)] = c.random.point(0.1f);
    Runs runs(c);
    auto& masses = c.add<float>("masses", c.items);
    for (float& mass : masses.span()) mass = c.random.real(0.1f, 10.0f);
    auto& moments = add_moments(c, c.items);
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& strains = add_points(c, "strains", 2 * (c.items + 1));
    auto& rests = c.add<float4>("rests", 7 * c.items);
    auto& bearings = add_points(c, "bearings", WEFT_BEARING_PARTS * (c.items + 1));
    c.launch = launch(kernels::solve_bodies, c.segments, lags, runs.first, runs.counts, masses,
                      moments, motions, strains, rests, bearings, c.random.integer(0, 1),
                      c.random.integer(0, 1), c.random.integer(0, 1), Runs::kMost, lag_count,
                      c.items, c.random.integer(0, 1) == 0 ? 0.0f : 50.0f);
}

void strains_case(KernelCase& c) {
    const int lag_count = c.items + Runs::kMost;
    auto& lags = c.add<float4>("lags", WEFT_BODY_PARTS * lag_count);
    fill_forms(c, lags, lag_count, 0);
    auto& virials = add_points(c, "virials", WEFT_VIRIAL_PARTS * lag_count);
    Runs runs(c);
    auto& masses = c.add<float>("masses", c.items);
    for (float& mass : masses.span()) mass = c.random.real(0.1f, 10.0f);
    auto& stiffness = c.add<float>("stiffness", 2 * c.items);
    for (float& s : stiffness.span()) s = std::max(c.random.real(-1e3f, 1e4f), 0.0f);
    auto& moments = add_moments(c, c.items);
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& strains = add_points(c, "strains", 2 * (c.items + 1));
    c.launch =
        launch(kernels::solve_strains, c.segments, lags, virials, runs.first, runs.counts, masses,
               stiffness, moments, motions, strains, 1e-4f, Runs::kMost, lag_count, c.items);
}

void virials_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& gradients = c.add<float>("gradients", 9 * c.items);
    for (float& g : gradients.span()) g = c.random.real(-1.0f, 1.0f);
    Columns columns(c);
    auto& origins = add_indices(c, "origins", c.items, c.items);
    auto& partials = c.add<float4>("partials", WEFT_VIRIAL_PARTS * c.items);
    c.launch = launch(kernels::add_virials, c.segments, positions, gradients, columns.members,
                      columns.shares, columns.rows, origins, partials, c.items, c.items);
}

/// What solve_bodies leaves: positive masses, and semi-definite forms; nothing of some bodies.
Buffer<float4>& add_rests(KernelCase& c) {
    auto& rests = c.add<float4>("rests", 7 * c.items);
    fill_forms(c, rests, c.items, 0);
    for (int b = 0; b < c.items; ++b) {
        rests[at(5 * c.items + b)] = c.random.point(0.1f);
        rests[at(6 * c.items + b)] = c.random.point(0.1f);
        rests[at(6 * c.items + b)].w = rests[at(b)].x;
    }
    return rests;
}

void groups_case(KernelCase& c) {
    auto& rests = add_rests(c);
    auto& moments = add_moments(c, c.items);
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& firsts = c.add<int>("firsts", kTables * c.items);
    auto& counts = c.add<int>("counts", kTables * c.items);
    for (std::size_t b = 0; b < firsts.count(); ++b) {
        const int place = static_cast<int>(b) % c.items;
        firsts[b] = c.random.integer(0, place);
        counts[b] = c.random.integer(0, std::min(5, c.items - firsts[b]));
    }
    auto& members = add_indices(c, "members", kTables * c.items, c.items);
    auto& are_led = add_flags(c, "are_led", c.items + 1);
    auto& group_motions = c.add<float4>("group_motions", 3 * c.items);
    c.launch =
        launch(kernels::solve_groups, c.segments, rests, moments, motions, firsts, counts, members,
               are_led, group_motions, random_level(c), kLevels, c.items, kInstance);
}

void add_groups_case(KernelCase& c) {
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& bearings = add_points(c, "bearings", WEFT_BEARING_PARTS * (c.items + 1));
    auto& masses = c.add<float>("masses", c.items);
    for (float& mass : masses.span()) mass = c.random.real(0.1f, 10.0f);
    auto& rests = add_points(c, "rests", 7 * c.items);
    auto& moments = add_moments(c, c.items);
    auto& group_motions = add_points(c, "group_motions", 3 * c.items);
    auto& leaders = add_indices(c, "leaders", kTables * c.items, c.items);
    c.launch = launch(kernels::add_groups, c.segments, motions, bearings, masses, rests, moments,
                      group_motions, leaders, c.random.integer(0, 1), random_level(c), kLevels,
                      c.items, kInstance);
}

void move_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& deviations = add_points(c, "deviations", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    auto& motions = add_points(c, "motions", 2 * (kBodies + 1));
    auto& strains = add_points(c, "strains", 2 * (kBodies + 1));
    auto& moments = add_moments(c, kBodies);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies + 1);
    auto& are_led = add_flags(c, "are_led", kBodies + 1);
    auto& group_motions = add_points(c, "group_motions", 3 * kBodies);
    auto& leaders = add_indices(c, "leaders", kTables * kBodies, kBodies);
    for (int b = 0; b < kBodies; ++b) {  // beside solids, and not
        group_motions[at(2 * kBodies + b)].w = static_cast<float>(b % 2);
        moments[at(6 * (kBodies + 1) + b)].w = c.random.real(0.0f, 1.0f);
    }
    c.launch = launch(kernels::move_bodies, c.segments, positions, deviations, velocities, motions,
                      strains, moments, are_led, bodies, group_motions, leaders, 240.0f, 50.0f,
                      kLevels, kBodies, kInstance);
}

/// Of solids' vertices and of others, in groups that give way and in others.
void stops_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& anchors = add_points(c, "anchors", c.items);
    const Planes planes(c);
    auto& hardness = c.add<float>("hardness", c.items);
    for (float& k : hardness.span()) k = std::max(c.random.real(-1e3f, 1e4f), 0.0f);
    auto& scene_bodies = add_indices(c, "scene_bodies", c.items, kBodies);
    auto& borne = add_flags(c, "borne", kBodies * kSubsteps);
    Columns columns(c);
    Pushes pushes(c);
    auto& needs = add_indices(c, "push_needs", c.items, 9);
    c.launch =
        launch(kernels::collect_stops, c.segments, positions, targets, anchors, planes.least,
               planes.rows, planes.counts, planes.all, hardness, scene_bodies, borne,
               columns.members, columns.shares, columns.rows, pushes.rows.rows, pushes.rows.counts,
               needs, pushes.codes, pushes.sides, pushes.slips, pushes.forces, pushes.points,
               pushes.other_points, pushes.presses, c.items, kBodies, kBodies, 0.02f, kInstance);
}

void lead_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& motions = add_points(c, "motions", 2 * (kBodies + 1));
    auto& strains = add_points(c, "strains", 2 * (kBodies + 1));
    auto& moments = add_moments(c, kBodies);
    auto& are_led = add_flags(c, "are_led", kBodies + 1);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies + 1);
    c.launch = launch(kernels::lead_bodies, c.segments, positions, motions, strains, moments,
                      are_led, bodies, std::max(c.random.real(-0.5f, 1.0f), 0.0f), kBodies);
}

const bool added =
    add_case("collect_pushes", collect_case) && add_case("collect_no_pushes", collect_none_case) &&
    add_case("collect_stops", stops_case) && add_case("add_pushed_lags", lags_case) &&
    add_case("solve_bodies", bodies_case) && add_case("solve_groups", groups_case) &&
    add_case("add_groups", add_groups_case) && add_case("add_moments", moments_case) &&
    add_case("weigh_bodies", weigh_case) && add_case("move_bodies", move_case) &&
    add_case("lead_bodies", lead_case) && add_case("solve_strains", strains_case) &&
    add_case("add_virials", virials_case);

}  // namespace
}  // namespace weft::test
