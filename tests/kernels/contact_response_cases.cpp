#include <numeric>

#include "kernels/contact/begin.h"
#include "kernels/contact/fences.h"
#include "kernels/contact/fill.h"
#include "kernels/contact/quiet.h"
#include "kernels/contact/rising.h"
#include "kernels/contact/rows.h"
#include "kernels/contact/sticking.h"
#include "kernels/contact/terms.h"
#include "kernels/contact/truncate.h"
#include "kernels/newton/contacts.h"
#include "kernels/xpbd/contacts.h"
#include "tests/kernels/contact_response_parts.h"

namespace weft::test {
namespace {

using namespace response;

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
    const Planes planes(c);
    auto& cut = c.add<int>("cut", c.items);
    c.launch = launch(kernels::truncate_contacts, c.segments, positions, anchors, planes.least,
                      planes.rows, planes.counts, planes.all, cut, 0.02f, 0.005f, kIteration,
                      c.flavour == Flavour::kRandom ? 0 : 1);
}

void balls_case(KernelCase& c) {
    auto& positions = add_points(c, "positions", c.items);
    auto& anchors = add_points(c, "anchors", c.items);
    for (float4& a : anchors.span()) a.w = c.random.real(0.0f, 2.0f * kSize);
    auto& cut = c.add<int>("cut", c.items);
    c.launch = launch(kernels::hold_in_balls, c.segments, positions, anchors, cut, kIteration,
                      c.flavour == Flavour::kRandom ? 0 : 1);
}

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

void rise_case(KernelCase& c) {
    OwnContacts contacts(c);
    auto& velocities = add_points(c, "velocities", c.items);
    auto& targets = add_points(c, "targets", c.items);
    auto& gravity = c.add<float4>("gravity", 2);
    if (c.flavour == Flavour::kRandom) gravity[1] = {0.3f, -0.7f, 0.2f, 0.0f};
    c.launch = launch(kernels::let_rise, c.segments, contacts.positions, velocities,
                      contacts.rows.rows, contacts.rows.counts, contacts.corner0, contacts.corner1,
                      contacts.corner2, contacts.corner3, contacts.normals, contacts.weights,
                      contacts.measures, targets, gravity, 0.5f, kInstance);
}

void recall_case(KernelCase& c) {
    Contacts contacts(c);
    auto& kept = add_points(c, "kept", 3 * c.items);
    auto& anchors = add_points(c, "anchors", c.items);
    c.launch = launch(kernels::recall_slips, c.segments, anchors, kept, contacts.rows.rows,
                      contacts.rows.counts, contacts.corner0, contacts.corner1, contacts.corner2,
                      contacts.corner3, contacts.normals, contacts.weights, contacts.measures,
                      contacts.slips, c.items);
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
    auto& snapshots = add_points(c, "snapshots", 2 * c.items);
    c.launch = launch(kernels::share_masses, c.segments, contacts.positions, contacts.rows.rows,
                      contacts.rows.counts, contacts.measures, add_least(c), snapshots, c.items,
                      kIteration, 1);
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

void busy_case(KernelCase& c) {
    auto& begin = c.add<int>("around_begin", c.items + 1);
    for (int i = 0; i < c.items; ++i) begin[at(i + 1)] = begin[at(i)] + c.random.integer(1, 9);
    auto& around = add_indices(c, "around", begin[at(c.items)], c.items);
    auto& near_counts = c.add<int>("near_counts", c.items);
    for (int& count : near_counts.span()) count = c.random.integer(0, 9) == 0 ? 3 : 0;
    auto& busy = add_indices(c, "busy", c.items, 4);
    c.launch =
        launch(kernels::find_busy_patches, c.segments, begin, around, near_counts, busy, kInstance);
}

/// A surface of nonsense, and pairs that nobody found: what counts is that all targets make the
/// same of them.
void fill_case(KernelCase& c) {
    const int triangle_count = 2 * c.items;
    const int edge_count = 3 * c.items;
    auto& anchors = add_points(c, "anchors", c.items);
    auto& goals = add_points(c, "goals", c.items);
    auto& stiffness = c.add<float>("stiffness", 2 * c.items);
    for (float& k : stiffness.span()) k = c.random.real(1.0f, 100.0f);
    // Every seventh vertex is of no sheet.
    for (int v = 0; v < c.items; v += 7) stiffness[at(c.items + v)] = -1.0f;
    // In any order.
    auto& apexes = c.add<int>("apexes", c.items);
    std::iota(apexes.span().begin(), apexes.span().end(), 0);
    for (int i = 0; i < c.items; ++i) std::swap(apexes[at(i)], apexes[at(c.random.integer(0, i))]);
    const auto [triangle_begin, triangle_list] = add_lists(c, "triangle", c.items, triangle_count);
    const auto [edge_begin, edge_list] = add_lists(c, "edge", c.items, edge_count);
    auto& triangles = add_indices(c, "triangles", 3 * triangle_count, c.items);
    auto& edges = add_indices(c, "edges", 2 * edge_count, c.items);
    auto& patches = c.add<int>("patches", c.items);
    for (int i = 0; i < c.items; ++i) patches[at(i)] = i / 5;
    auto& busy = add_indices(c, "busy", c.items, 4);
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
    // Who is not busy had no rows.
    for (int i = 0; i < c.items; ++i) {
        const std::size_t vertex = at(apexes[at(i)]);
        if (busy[at(i / 5)] > 0) continue;
        least[vertex] = WEFT_NO_PLANE;
        plane_rows.counts[vertex] = contacts.rows.counts[vertex] = 0;
    }
    c.launch = launch(kernels::fill_contacts, c.segments, anchors, goals, stiffness, apexes,
                      *triangle_begin, *triangle_list, *edge_begin, *edge_list, triangles, edges,
                      patches, busy, vt.rows, vt.counts, vt_others, tv.rows, tv.counts, tv_others,
                      ee.rows, ee.counts, ee_others, plane_rows.rows, plane_rows.counts,
                      plane_needs, planes, contacts.rows.rows, contacts.rows.counts, needs,
                      contacts.corner0, contacts.corner1, contacts.corner2, contacts.corner3,
                      contacts.normals, contacts.weights, contacts.measures, least, nearest,
                      c.items, triangle_count, edge_count, kRange, 0.05f * kRange, 4.0f, kInstance);
}

const bool added =
    add_case("begin_contacts", begin_case) && add_case("find_strays", strays_case) &&
    add_case("find_unquiet", unquiet_case) && add_case("count_cut", count_case) &&
    add_case("truncate_contacts", truncate_case) && add_case("hold_in_balls", balls_case) &&
    add_case("gather_contacts", gather_case) && add_case("take_snapshot", snapshot_case) &&
    add_case("find_busy_patches", busy_case) && add_case("fill_contacts", fill_case);
const bool added_of_solvers =
    add_case("contact_terms", terms_case) && add_case("measure_contacts", measure_case) &&
    add_case("let_rise", rise_case) && add_case("share_masses", share_case) &&
    add_case("project_contacts", project_case) && add_case("rub_contacts", rub_case) &&
    add_case("couple_contacts", couple_case) && add_case("multiply_contacts", multiply_case) &&
    add_case("recall_slips", recall_case) && add_case("keep_slips", keep_case);

}  // namespace
}  // namespace weft::test
