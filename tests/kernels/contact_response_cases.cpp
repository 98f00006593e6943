#include <algorithm>
#include <array>

#include "kernels/contact/begin.h"
#include "kernels/contact/fences.h"
#include "kernels/contact/fill.h"
#include "kernels/contact/groups.h"
#include "kernels/contact/quiet.h"
#include "kernels/contact/rows.h"
#include "kernels/contact/sticking.h"
#include "kernels/contact/strains.h"
#include "kernels/contact/terms.h"
#include "kernels/contact/truncate.h"
#include "kernels/newton/contacts.h"
#include "kernels/xpbd/contacts.h"
#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kSize = 0.3f;
constexpr float kRange = 0.1f;
constexpr int kRoom = 6;
constexpr int kBodies = 4;
constexpr int kSubsteps = 8;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Points of which some are held; degenerate: many in one place.
Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (float4& x : points.span()) {
        x = c.random.point(kSize);
        if (c.flavour == Flavour::kDegenerate && c.random.integer(0, 1) == 0) x = points[0];
        x.w = c.random.integer(0, 5) == 0 ? 0.0f : c.random.real(0.5f, 2.0f);
    }
    return points;
}

Buffer<int>& add_indices(KernelCase& c, const std::string& name, int count, int end) {
    auto& indices = c.add<int>(name, count);
    for (int& index : indices.span()) index = c.random.integer(0, end - 1);
    return indices;
}

/// The rows of a table as RowTable places them, of all lengths.
struct Rows {
    Buffer<int>& rows;
    Buffer<int>& counts;
    int entries = 0;

    Rows(KernelCase& c, const std::string& name, int items, int room)
        : rows(c.add<int>(name + ".rows", 2 * items)), counts(c.add<int>(name + ".counts", items)) {
        Buffer<int> begin("strips", 2);
        begin[1] = items;
        RowTable table("table", {&begin, 0, 1, 1}, room);
        std::copy_n(table.rows().data(), rows.count(), rows.data());
        entries = static_cast<int>(table.add_column<int>("others").count());
        for (int& count : counts.span()) count = c.random.integer(0, c.random.integer(0, room));
    }
};

Buffer<float4>& add_normals(KernelCase& c, const std::string& name, int count, float low,
                            float high) {
    auto& normals = c.add<float4>(name, count);
    for (float4& n : normals.span()) {
        n = c.random.point(1.0f);
        const float size = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) + 1e-6f;
        n = {n.x / size, n.y / size, n.z / size, c.random.real(low, high)};
    }
    return normals;
}

void begin_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& previous = add_points(c, "previous", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& goals = c.add<float4>("goals", c.items);
    auto& anchors = c.add<float4>("anchors", c.items);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies);
    auto& carried = add_points(c, "carried", kBodies * kSubsteps);
    auto& strides = c.add<float4>("strides", c.items);
    c.launch = launch(kernels::begin_contacts, c.segments, positions, previous, targets, goals,
                      anchors, strides, bodies, carried, kBodies, 0.1f, 0.3f, kInstance);
}

/// Boxes of which most are within their fences.
void strays_case(KernelCase& c) {
    auto& low = add_points(c, "low", c.items);
    auto& high = add_points(c, "high", c.items);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies);
    auto& carried = add_points(c, "carried", kBodies * kSubsteps);
    auto& chunks = add_indices(c, "chunks", c.items, kBodies);
    auto& fences = add_points(c, "fences", 2 * kBodies * kSubsteps);
    for (std::size_t f = 0; f < fences.count(); ++f) {
        const float side = f / kBodies % 2 == 0 ? -0.5f : 0.5f;
        float4& corner = fences[f];
        corner = {corner.x + side, corner.y + side, corner.z + side, 0.0f};
    }
    auto& strays = add_indices(c, "strays", c.items, 2);
    c.launch = launch(kernels::find_strays, c.segments, low, high, bodies, carried, chunks, fences,
                      strays, kBodies, kBodies, kInstance);
}

void unquiet_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& anchors = add_points(c, "anchors", c.items);
    for (float4& a : anchors.span()) a.w = c.random.real(0.0f, 0.3f);
    auto& goals = add_points(c, "goals", c.items);
    auto& quiet = c.add<float>("quiet", c.items);
    for (float& limit : quiet.span()) limit = c.random.real(0.0f, 2.0f);
    auto& unquiet = add_indices(c, "unquiet", c.items, 2);
    c.launch = launch(kernels::find_unquiet, c.segments, positions, anchors, goals, quiet, unquiet,
                      kInstance);
}

void count_case(KernelCase& c) {
    auto& cut = add_indices(c, "cut", c.items, 3);
    auto& anchors = add_points(c, "anchors", c.items);
    auto& goals = add_points(c, "goals", c.items);
    auto& counts = add_indices(c, "counts", 2 * c.items, 9);
    auto& ways = c.add<float>("ways", c.items);
    for (float& way : ways.span()) way = c.random.real(0.0f, kSize);
    c.launch = launch(kernels::count_cut, c.segments, cut, anchors, goals, counts, ways, c.items,
                      kInstance);
}

void truncate_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& anchors = add_points(c, "anchors", c.items);
    for (float4& a : anchors.span()) a.w = c.random.real(0.0f, 2.0f * kSize);
    auto& least = c.add<float>("least", c.items);
    const float lowest = c.flavour == Flavour::kRandom ? 0.0f : -0.1f;
    Rows planes(c, "planes", c.items, kRoom);
    auto& entries = add_normals(c, "planes", planes.entries, lowest, 0.2f);
    for (int v = 0; v < c.items; ++v) {
        least[at(v)] = 1e30f;
        for (int k = 0; k < planes.counts[at(v)]; ++k) {
            const float4& plane = entries[at(planes.rows[at(v)] + RowTable::kStride * k)];
            least[at(v)] = std::min(least[at(v)], plane.w);
        }
    }
    auto& cut = c.add<int>("cut", c.items);
    c.launch = launch(kernels::truncate_contacts, c.segments, positions, anchors, least,
                      planes.rows, planes.counts, entries, cut, 0.02f, 0.005f);
}

struct Contacts {
    Rows rows;
    Buffer<int>&corner0, &corner1, &corner2, &corner3;
    Buffer<float4>&normals, &weights, &measures, &slips;

    explicit Contacts(KernelCase& c)
        : rows(c, "contacts", c.items, kRoom),
          corner0(add_indices(c, "corner0", rows.entries, c.items)),
          corner1(add_indices(c, "corner1", rows.entries, c.items)),
          corner2(add_indices(c, "corner2", rows.entries, c.items)),
          corner3(add_indices(c, "corner3", rows.entries, c.items)),
          normals(add_normals(c, "normals", rows.entries, -kRange, 2.0f * kRange)),
          weights(c.add<float4>("weights", rows.entries)),
          measures(c.add<float4>("measures", rows.entries)),
          slips(add_points(c, "earlier_slips", rows.entries)) {
        for (std::size_t e = 0; e < weights.count(); ++e) {
            const float u = c.random.real(0.0f, 0.5f);
            const float v = c.random.real(0.0f, 0.5f);
            weights[e] = {1.0f, -u, -v, u + v - 1.0f};
            measures[e] = {u, 2.0f * u, c.random.real(1.0f, 1e4f), kRange};
        }
    }
};

void gather_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& snapshots = add_points(c, "snapshots", 2 * c.items);
    auto& vertices = add_indices(c, "vertices", c.items, c.items);
    Contacts contacts(c);
    auto& sums = c.add<float>("sums", 9 * c.items);
    for (float& sum : sums.span()) sum = c.random.real(-1.0f, 1.0f);
    c.launch = launch(kernels::gather_contacts, c.segments, positions, snapshots, vertices,
                      contacts.rows.rows, contacts.rows.counts, contacts.corner0, contacts.corner1,
                      contacts.corner2, contacts.corner3, contacts.normals, contacts.weights,
                      contacts.measures, contacts.slips, sums, c.items, c.items, kIteration,
                      c.flavour == Flavour::kRandom ? 0.3f : 0.0f, 0.02f);
}

void couple_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    Contacts contacts(c);
    auto& curvatures = c.add<float>("curvatures", contacts.rows.entries);
    auto& grips = c.add<float>("grips", contacts.rows.entries);
    c.launch = launch(kernels::couple_contacts, c.segments, positions, contacts.rows.rows,
                      contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
                      contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
                      contacts.slips, curvatures, grips,
                      c.flavour == Flavour::kRandom ? 0.3f : 0.0f, 0.02f);
}

void multiply_case(KernelCase& c) {
    auto& directions = add_points(c, "directions", c.items);
    Contacts contacts(c);
    auto& curvatures = c.add<float>("curvatures", contacts.rows.entries);
    auto& grips = c.add<float>("grips", contacts.rows.entries);
    for (float& value : curvatures.span()) value = c.random.real(0.0f, 1e4f);
    for (float& value : grips.span()) value = c.random.real(0.0f, 1e3f);
    auto& products = c.add<float>("products", 3 * c.items);
    for (float& value : products.span()) value = c.random.real(-1.0f, 1.0f);
    c.launch = launch(kernels::multiply_contacts, c.segments, directions, contacts.rows.rows,
                      contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
                      contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
                      curvatures, grips, products, c.items);
}

/// Some have no pairs.
Buffer<float>& add_least(KernelCase& c) {
    auto& least = c.add<float>("least", c.items);
    for (float& room : least.span()) {
        room = c.random.integer(0, 2) == 0 ? c.random.real(-0.1f, 0.1f) : WEFT_NO_PLANE;
    }
    return least;
}

void snapshot_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& snapshots = c.add<float4>("snapshots", 2 * c.items);
    c.launch = launch(kernels::take_snapshot, c.segments, positions, add_least(c), snapshots,
                      c.items, kIteration, 1);
}

/// What kernels over the rows of all vertices take; each vertex is a corner of its contacts.
struct OwnContacts : Contacts {
    Buffer<float4>& positions;

    explicit OwnContacts(KernelCase& c)
        : Contacts(c), positions(add_points(c, "positions", c.items)) {
        const std::array corners{&corner0, &corner1, &corner2, &corner3};
        for (int v = 0; v < c.items; ++v) {
            for (int k = 0; k < rows.counts[at(v)]; ++k) {
                auto& corner = *corners[at(c.random.integer(0, 3))];
                corner[at(rows.rows[at(v)] + RowTable::kStride * k)] = v;
            }
        }
        if (c.flavour == Flavour::kRandom) return;
        for (float4& w : weights.span()) {
            if (c.random.integer(0, 2) == 0) w = {0.0f, 1.0f, w.z, w.w};
        }
    }
};

void terms_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& slots = c.add<int>("slots", c.items);
    for (int v = 0; v < c.items; ++v) slots[at(v)] = v;
    auto& terms = c.add<float>("terms", c.items);
    c.launch = launch(kernels::contact_terms, c.segments, contacts.positions, contacts.rows.rows,
                      contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
                      contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
                      slots, terms);
}

void measure_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& previous = add_points(c, "previous", c.items);
    auto& energies = c.add<float>("energies", 2 * c.items);
    c.launch = launch(kernels::measure_contacts, c.segments, contacts.positions, previous,
                      contacts.rows.rows, contacts.rows.counts, contacts.corner0, contacts.corner1,
                      contacts.corner2, contacts.corner3, contacts.normals, contacts.weights,
                      contacts.measures, energies, c.items, kInstance);
}

void recall_case(KernelCase& c) {
    Contacts contacts(c);
    auto& kept = add_points(c, "kept", 3 * c.items);
    c.launch =
        launch(kernels::recall_slips, c.segments, kept, contacts.rows.rows, contacts.rows.counts,
               contacts.corner0, contacts.corner1, contacts.corner2, contacts.corner3,
               contacts.normals, contacts.weights, contacts.slips, c.items);
}

void keep_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& kept = add_points(c, "kept", 3 * c.items);
    c.launch = launch(kernels::keep_slips, c.segments, contacts.positions, contacts.rows.rows,
                      contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
                      contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
                      contacts.slips, kept, c.items, 0.3f);
}

void share_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& snapshots = c.add<float4>("snapshots", 2 * c.items);
    c.launch = launch(kernels::share_masses, c.segments, contacts.positions, contacts.rows.counts,
                      add_least(c), snapshots, c.items, kIteration, 1);
}

void project_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& snapshots = add_points(c, "snapshots", 2 * c.items);
    auto& multipliers = c.add<float>("multipliers", contacts.rows.entries);
    for (float& l : multipliers.span()) l = c.random.real(0.0f, 0.1f);
    c.launch = launch(kernels::project_contacts, c.segments, contacts.positions, snapshots,
                      contacts.rows.rows, contacts.rows.counts, contacts.corner0, contacts.corner1,
                      contacts.corner2, contacts.corner3, contacts.normals, contacts.weights,
                      contacts.measures, multipliers, c.items, 1e4f, kIteration);
}

void rub_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& snapshots = add_points(c, "snapshots", 2 * c.items);
    auto& multipliers = c.add<float>("multipliers", contacts.rows.entries);
    for (float& l : multipliers.span()) l = std::max(c.random.real(-0.02f, 0.1f), 0.0f);
    auto& rubs = add_points(c, "rubs", contacts.rows.entries);
    c.launch =
        launch(kernels::rub_contacts, c.segments, contacts.positions, snapshots, contacts.rows.rows,
               contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
               contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
               contacts.slips, multipliers, rubs, c.items, kIteration, 0.3f, 0.1f);
}

/// Lists of random entries: begin [items + 1], list.
std::pair<Buffer<int>*, Buffer<int>*> add_lists(KernelCase& c, const std::string& name, int items,
                                                int end) {
    auto& begin = c.add<int>(name + "_begin", items + 1);
    for (int i = 0; i < items; ++i) begin[at(i + 1)] = begin[at(i)] + c.random.integer(0, 4);
    auto& list = add_indices(c, name + "_list", begin[at(items)] + 1, end);
    return {&begin, &list};
}

/// A surface of nonsense, and pairs that nobody found: what counts is that all targets make the
/// same of them.
void fill_case(KernelCase& c) {
    const int triangle_count = 2 * c.items;
    const int edge_count = 3 * c.items;
    auto& anchors = add_points(c, "anchors", c.items);
    auto& goals = add_points(c, "goals", c.items);
    auto& stiffness = c.add<float>("stiffness", c.items);
    for (float& k : stiffness.span()) k = c.random.real(1.0f, 100.0f);
    auto& surface = add_indices(c, "surface", c.items, c.items + 1);
    const auto [triangle_begin, triangle_list] = add_lists(c, "triangle", c.items, triangle_count);
    const auto [edge_begin, edge_list] = add_lists(c, "edge", c.items, edge_count);
    auto& triangles = add_indices(c, "triangles", 3 * triangle_count, c.items);
    auto& edges = add_indices(c, "edges", 2 * edge_count, c.items);
    auto& apexes = add_indices(c, "apexes", c.items, c.items);
    const auto [patch_begin, patch_list] = add_lists(c, "patch", c.items, c.items);
    auto& near_counts = add_indices(c, "near_counts", c.items, 3);
    Rows vt(c, "vt", c.items, 3);
    Rows tv(c, "tv", triangle_count, 2);
    Rows ee(c, "ee", edge_count, 2);
    auto& vt_others = add_indices(c, "vt.others", vt.entries, 2 * triangle_count);
    auto& tv_others = add_indices(c, "tv.others", tv.entries, 2 * c.items);
    auto& ee_others = add_indices(c, "ee.others", ee.entries, 2 * edge_count);
    Rows plane_rows(c, "planes", c.items, kRoom);
    auto& plane_needs = add_indices(c, "plane_needs", c.items, 9);
    auto& planes = c.add<float4>("planes", plane_rows.entries);
    Contacts contacts(c);
    auto& needs = add_indices(c, "needs", c.items, 9);
    auto& least = add_least(c);
    auto& nearest = c.add<float>("nearest", c.items);
    // Who had no pairs had no rows.
    for (int i = 0; i < c.items; ++i) {
        if (least[at(i)] == WEFT_NO_PLANE)
            plane_rows.counts[at(i)] = contacts.rows.counts[at(i)] = 0;
    }
    c.launch =
        launch(kernels::fill_contacts, c.segments, anchors, goals, stiffness, surface,
               *triangle_begin, *triangle_list, *edge_begin, *edge_list, triangles, edges, apexes,
               *patch_begin, *patch_list, near_counts, vt.rows, vt.counts, vt_others, tv.rows,
               tv.counts, tv_others, ee.rows, ee.counts, ee_others, plane_rows.rows,
               plane_rows.counts, plane_needs, planes, contacts.rows.rows, contacts.rows.counts,
               needs, contacts.corner0, contacts.corner1, contacts.corner2, contacts.corner3,
               contacts.normals, contacts.weights, contacts.measures, least, nearest, c.items,
               triangle_count, edge_count, kRange, 0.05f * kRange, 4.0f, kInstance);
}

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

/// What a body has of contacts, as collect_pushes leaves it.
struct Pushes {
    Rows rows;
    Buffer<int>& codes;
    Buffer<float4>&sides, &slips, &forces, &points, &other_points, &standing;

    explicit Pushes(KernelCase& c)
        : rows(c, "pushes", c.items, kRoom),
          codes(add_indices(c, "codes", rows.entries, 2 * (kBodies + 1))),
          sides(add_normals(c, "sides", rows.entries, -kRange, 2.0f * kRange)),
          slips(add_points(c, "slips", rows.entries)),
          forces(c.add<float4>("forces", rows.entries)),
          points(add_points(c, "points", rows.entries)),
          other_points(add_points(c, "other_points", rows.entries)),
          standing(add_points(c, "standing", c.items)) {
        for (float4& f : forces.span()) f = {1.0f, 2.0f, c.random.real(1.0f, 1e4f), kRange};
    }
};

void collect_case(KernelCase& c) {
    auto& targets = add_points(c, "targets", c.items);
    Columns columns(c);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies + 1);
    auto& leaders = add_indices(c, "leaders", kSubsteps * kBodies, kBodies);
    OwnContacts contacts(c);
    for (float4& m : contacts.measures.span()) m.x += 0.5f;
    Pushes pushes(c);
    auto& needs = add_indices(c, "push_needs", c.items, 9);
    c.launch = launch(kernels::collect_pushes, c.segments, contacts.positions, targets,
                      columns.members, columns.shares, columns.rows, bodies, leaders,
                      contacts.rows.rows, contacts.rows.counts, contacts.corner0, contacts.corner1,
                      contacts.corner2, contacts.corner3, contacts.normals, contacts.weights,
                      contacts.measures, contacts.slips, pushes.rows.rows, pushes.rows.counts,
                      needs, pushes.codes, pushes.sides, pushes.slips, pushes.forces, pushes.points,
                      pushes.other_points, pushes.standing, c.items, kBodies,
                      c.flavour == Flavour::kRandom ? 0.3f : 0.0f, kInstance);
}

void moments_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& targets = add_points(c, "targets", c.items);
    Columns columns(c);
    auto& origins = add_indices(c, "origins", c.items, c.items);
    auto& partials = c.add<float4>("partials", WEFT_MOMENT_PARTS * c.items);
    c.launch = launch(kernels::add_moments, c.segments, positions, targets, columns.members,
                      columns.shares, columns.rows, origins, partials, c.items);
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
    const int sum_count = c.items + Runs::kMost;
    auto& sums = add_points(c, "sums", WEFT_MOMENT_PARTS * sum_count);
    Runs runs(c);
    auto& moments = c.add<float4>("moments", WEFT_MOMENT_PARTS * (c.items + 1));
    c.launch = launch(kernels::weigh_bodies, c.segments, sums, runs.first, runs.counts, moments,
                      Runs::kMost, sum_count, c.items);
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
    Pushes pushes(c);
    auto& partials = c.add<float4>("partials", WEFT_BODY_PARTS * c.items);
    c.launch = launch(kernels::add_pushed_lags, c.segments, pushes.standing, bodies, masses,
                      moments, motions, strains, pushes.rows.rows, pushes.rows.counts, pushes.codes,
                      pushes.sides, pushes.slips, pushes.forces, pushes.points, pushes.other_points,
                      partials, c.flavour == Flavour::kRandom ? 0.3f : 0.0f, 0.02f, 1e-4f,
                      c.random.integer(0, 1), c.random.integer(0, 1), c.items, kBodies);
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

void bodies_case(KernelCase& c) {
    const int lag_count = c.items + Runs::kMost;
    auto& lags = c.add<float4>("lags", WEFT_BODY_PARTS * lag_count);
    fill_forms(c, lags, lag_count, 0);
    fill_forms(c, lags, lag_count, 7);
    for (int k = 5 * lag_count; k < 7 * lag_count; ++k) lags[at(k)] = c.random.point(0.1f);
    Runs runs(c);
    auto& masses = c.add<float>("masses", c.items);
    for (float& mass : masses.span()) mass = c.random.real(0.1f, 10.0f);
    auto& moments = add_moments(c, c.items);
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& strains = add_points(c, "strains", 2 * (c.items + 1));
    auto& rests = c.add<float4>("rests", 7 * c.items);
    c.launch =
        launch(kernels::solve_bodies, c.segments, lags, runs.first, runs.counts, masses, moments,
               motions, strains, rests, c.random.integer(0, 1), Runs::kMost, lag_count, c.items);
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
    auto& firsts = c.add<int>("firsts", kSubsteps * c.items);
    auto& counts = c.add<int>("counts", kSubsteps * c.items);
    for (std::size_t b = 0; b < firsts.count(); ++b) {
        const int place = static_cast<int>(b) % c.items;
        firsts[b] = c.random.integer(0, place);
        counts[b] = c.random.integer(0, std::min(5, c.items - firsts[b]));
    }
    auto& members = add_indices(c, "members", kSubsteps * c.items, c.items);
    auto& group_motions = c.add<float4>("group_motions", 3 * c.items);
    c.launch = launch(kernels::solve_groups, c.segments, rests, moments, motions, firsts, counts,
                      members, group_motions, c.items, kInstance);
}

void add_groups_case(KernelCase& c) {
    auto& motions = add_points(c, "motions", 2 * (c.items + 1));
    auto& rests = add_points(c, "rests", 7 * c.items);
    auto& moments = add_moments(c, c.items);
    auto& group_motions = add_points(c, "group_motions", 3 * c.items);
    auto& leaders = add_indices(c, "leaders", kSubsteps * c.items, c.items);
    c.launch = launch(kernels::add_groups, c.segments, motions, rests, moments, group_motions,
                      leaders, c.items, kInstance);
}

void move_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& deviations = add_points(c, "deviations", c.items);
    auto& velocities = add_points(c, "velocities", c.items);
    auto& motions = add_points(c, "motions", 2 * (kBodies + 1));
    auto& strains = add_points(c, "strains", 2 * (kBodies + 1));
    auto& moments = add_moments(c, kBodies);
    auto& bodies = add_indices(c, "bodies", c.items, kBodies + 1);
    c.launch = launch(kernels::move_bodies, c.segments, positions, deviations, velocities, motions,
                      strains, moments, bodies, 240.0f, kBodies);
}

const bool added =
    add_case("begin_contacts", begin_case) && add_case("find_strays", strays_case) &&
    add_case("find_unquiet", unquiet_case) && add_case("count_cut", count_case) &&
    add_case("truncate_contacts", truncate_case) && add_case("gather_contacts", gather_case) &&
    add_case("take_snapshot", snapshot_case) && add_case("fill_contacts", fill_case) &&
    add_case("collect_pushes", collect_case) && add_case("add_pushed_lags", lags_case) &&
    add_case("solve_bodies", bodies_case) && add_case("solve_groups", groups_case) &&
    add_case("add_groups", add_groups_case) && add_case("add_moments", moments_case) &&
    add_case("weigh_bodies", weigh_case) && add_case("move_bodies", move_case) &&
    add_case("solve_strains", strains_case) && add_case("add_virials", virials_case);
const bool added_of_solvers =
    add_case("contact_terms", terms_case) && add_case("measure_contacts", measure_case) &&
    add_case("share_masses", share_case) && add_case("project_contacts", project_case) &&
    add_case("rub_contacts", rub_case) && add_case("couple_contacts", couple_case) &&
    add_case("multiply_contacts", multiply_case) && add_case("recall_slips", recall_case) &&
    add_case("keep_slips", keep_case);

}  // namespace
}  // namespace weft::test
