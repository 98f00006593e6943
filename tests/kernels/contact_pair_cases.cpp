#include "kernels/contact/nearing.h"
#include "kernels/contact/pairs.h"
#include "tests/kernels/contact_case_parts.h"

namespace weft::test {
namespace {

constexpr float kRange = 0.2f;
constexpr float kSpare = 0.01f;

void enclose_strides_case(KernelCase& c) {
    auto& strides = add_points(c, "strides", 20);
    auto& begin = add_begins(c, "begin", c.items, 1, 12);
    auto& hulls = add_numbers(c, "hulls", begin[at(c.items)], 20);
    auto& counts = add_numbers(c, "counts", c.items, 3);
    auto& low = c.add<float4>("low", c.items);
    auto& high = c.add<float4>("high", c.items);
    c.launch =
        launch(kernels::enclose_strides, c.segments, strides, begin, hulls, counts, low, high);
}

/// Some rows as they were, some with others; some worn out, some of another time.
void check_case(KernelCase& c) {
    Boxes boxes(c, "boxes", c.items, 0.3f);
    Boxes slants(c, "slants", 2 * c.items, 2.0f);
    Boxes strides(c, "strides", c.items, 0.02f);
    Table near(c, "near", c.items, 4);
    near.fill(c, c.items);
    Table kept(c, "kept", c.items, 3);
    kept.fill(c, c.items);
    for (int& count : kept.counts.span()) count = std::min(count, 3);
    auto& spent = c.add<float>("spent", static_cast<int>(kept.others.count()));
    for (float& way : spent.span()) way = c.random.real(0.0f, 0.2f);
    auto& slacks = c.add<float>("slacks", c.items);
    for (float& slack : slacks.span()) slack = c.random.real(1.0f, 3.0f);
    auto& stamps = c.add<int>("stamps", c.items);
    for (int& stamp : stamps.span()) stamp = 10 + c.random.integer(0, 9) / 9;
    for (int i = 0; i < c.items; ++i) {
        if (stamps[at(i)] != 10 || c.random.integer(0, 1) == 0) continue;
        const int count = std::min(kept.counts[at(i)], near.counts[at(i)]);
        near.counts[at(i)] = kept.counts[at(i)] = count;
    }
    auto& stale = add_numbers(c, "stale", c.items, 2);
    auto& epoch = c.add<int>("epoch", 1);
    auto& age = c.add<int>("age", 1);
    epoch[0] = 2;
    age[0] = 2;
    c.launch =
        launch(kernels::check_candidates, c.segments, boxes.low, boxes.high, slants.low,
               slants.high, strides.low, strides.high, near.rows, near.counts, near.others,
               kept.rows, kept.counts, kept.needs, kept.others, spent, slacks, stamps, stale, epoch,
               age, age, age, age, c.items, 0.1f, 0.01f, 0.1f, 20.0f, 8.0f, 2.0f, kInstance);
}

/// Rows of each item, some of them with entries.
Table add_rows(KernelCase& c, const std::string& name) {
    constexpr int kRoom = 3;
    Table table(c, name, c.items, kRoom);
    for (int& count : table.counts.span()) count = c.random.integer(0, kRoom);
    return table;
}

/// What collecting needs of patches.
struct Collecting {
    Patches patches;
    Buffer<int>& stale;
    Buffer<float>& slacks;

    explicit Collecting(KernelCase& c)
        : patches(c),
          stale(add_numbers(c, "stale", patches.count, 3)),
          slacks(c.add<float>("slacks", patches.count)) {
        for (int& flag : stale.span()) flag = flag > 0 ? 1 : 0;
        for (float& slack : slacks.span()) slack = c.random.real(0.0f, 0.1f);
    }
};

void collect_triangles_case(KernelCase& c) {
    Collecting from(c);
    Patches& patches = from.patches;
    auto& points = add_points(c, "points", c.items);
    auto& begin = add_begins(c, "triangles.begin", patches.count, 0, 6);
    const int triangles = begin[at(patches.count)];
    auto& corners = add_numbers(c, "corners", 3 * triangles, c.items);
    Boxes boxes(c, "boxes", triangles, 0.6f);
    enclose(patches.boxes, patches.count, begin, boxes);
    auto& knots = add_numbers(c, "knots", c.items, c.items);
    Table table = add_rows(c, "vt");
    c.launch = launch(kernels::collect_triangles, c.segments, points, patches.of_item,
                      patches.near.rows, patches.near.counts, patches.near.others, from.stale,
                      from.slacks, patches.boxes.low, patches.boxes.high, begin, corners, knots,
                      boxes.low, boxes.high, table.rows, table.counts, table.needs, table.others,
                      c.items, triangles, kHalo, kRange, kSpare, kInstance);
}

void collect_vertices_case(KernelCase& c) {
    Collecting from(c);
    Patches& patches = from.patches;
    auto& begin = add_begins(c, "vertices.begin", patches.count, 0, 6);
    const int vertices = begin[at(patches.count)] + 3;
    auto& points = add_points(c, "points", vertices);
    auto& corners = add_numbers(c, "corners", 3 * c.items, vertices);
    Boxes boxes(c, "boxes", c.items, 0.6f);
    for (int p = 0; p < patches.count; ++p) {
        make_empty(patches.boxes.low[at(p)], patches.boxes.high[at(p)]);
        for (int v = begin[at(p)]; v < begin[at(p + 1)]; ++v) {
            const float4& x = points[at(v)];
            const float q = x.w + 0.5f * kHalo;
            include(patches.boxes.low[at(p)], patches.boxes.high[at(p)],
                    {x.x - q, x.y - q, x.z - q, 0.0f}, {x.x + q, x.y + q, x.z + q, 0.0f});
        }
    }
    auto& knots = add_numbers(c, "knots", vertices, vertices);
    Table table = add_rows(c, "tv");
    c.launch =
        launch(kernels::collect_vertices, c.segments, points, patches.of_item, patches.near.rows,
               patches.near.counts, patches.near.others, from.stale, from.slacks, patches.boxes.low,
               patches.boxes.high, begin, corners, knots, boxes.low, boxes.high, table.rows,
               table.counts, table.needs, table.others, c.items, kHalo, kRange, kSpare, kInstance);
}

void collect_edges_case(KernelCase& c) {
    Collecting from(c);
    Patches& patches = from.patches;
    auto& begin = c.add<int>("edges.begin", patches.count + 1);
    for (int i = 0; i < c.items; ++i) begin[at(patches.of_item[at(i)] + 1)] = i + 1;
    auto& points = add_points(c, "points", c.items + 2);
    auto& ends = add_numbers(c, "ends", 2 * c.items, c.items + 2);
    auto& knots = add_numbers(c, "knots", c.items + 2, c.items + 2);
    Boxes boxes(c, "boxes", c.items, 0.6f);
    enclose(patches.boxes, patches.count, begin, boxes);
    Table table = add_rows(c, "ee");
    c.launch =
        launch(kernels::collect_edges, c.segments, points, patches.of_item, patches.near.rows,
               patches.near.counts, patches.near.others, from.stale, from.slacks, patches.boxes.low,
               patches.boxes.high, begin, ends, knots, boxes.low, boxes.high, table.rows,
               table.counts, table.needs, table.others, c.items, kRange, kSpare, kInstance);
}

/// Who is beyond an edge, who owns what, and which vertices are around which.
struct Features {
    Buffer<int>& beyond;
    Buffer<int>& owned;
    Buffer<int>& ring_begin;
    Buffer<int>& ring;

    Features(KernelCase& c, int vertices, int triangles)
        : beyond(c.add<int>("beyond", 3 * triangles)),
          owned(add_numbers(c, "owned", 6 * triangles, 2)),
          ring_begin(add_begins(c, "ring.begin", vertices, 1, 7)),
          ring(add_numbers(c, "ring", ring_begin[at(vertices)], vertices)) {
        for (int& vertex : beyond.span()) vertex = c.random.integer(-1, vertices - 1);
    }
};

/// Which patches have had others near to them, and which have not but do now.
struct Kept {
    Buffer<int>& counts;
    Buffer<int>& stale;

    Kept(KernelCase& c, const Patches& patches)
        : counts(add_numbers(c, "kept", patches.count, 3)),
          stale(add_numbers(c, "stale", patches.count, 2)) {
        for (int p = 0; p < patches.count; ++p) {
            if (patches.near.counts[at(p)] > 0 && counts[at(p)] == 0) stale[at(p)] = 1;
        }
    }
};

/// Any others below `of`, of items whose patch has one near to it.
void fill_near(KernelCase& c, const Patches& patches, Table& candidates, int of) {
    for (int i = 0; i < c.items; ++i) {
        const bool is_near = patches.near.counts[at(patches.of_item[at(i)])] > 0;
        candidates.counts[at(i)] = is_near ? c.random.integer(0, 4) : 0;
        for (int k = 0; k < candidates.counts[at(i)]; ++k) {
            candidates.others[at(candidates.rows[at(i)] + RowTable::kStride * k)] =
                c.random.integer(0, of - 1);
        }
    }
}

void find_triangles_case(KernelCase& c) {
    Patches patches(c);
    const int triangles = 2 * c.items;
    auto& points = add_points(c, "points", c.items);
    auto& corners = add_numbers(c, "corners", 3 * triangles, c.items);
    Features f(c, c.items, triangles);
    Table candidates(c, "candidates", c.items, 4);
    fill_near(c, patches, candidates, triangles);
    const Kept kept(c, patches);
    Table table = add_rows(c, "vt");
    c.launch =
        launch(kernels::find_triangles, c.segments, points, patches.of_item, patches.near.counts,
               kept.counts, kept.stale, candidates.rows, candidates.counts, candidates.others,
               corners, f.beyond, f.owned, f.ring_begin, f.ring, table.rows, table.counts,
               table.needs, table.others, c.items, triangles, kHalo, kLeast, kInstance);
}

void find_vertices_case(KernelCase& c) {
    Patches patches(c);
    const int vertices = c.items + 3;
    auto& points = add_points(c, "points", vertices);
    auto& corners = add_numbers(c, "corners", 3 * c.items, vertices);
    Features f(c, vertices, c.items);
    Table candidates(c, "candidates", c.items, 4);
    fill_near(c, patches, candidates, vertices);
    const Kept kept(c, patches);
    Table table = add_rows(c, "tv");
    c.launch =
        launch(kernels::find_vertices, c.segments, points, patches.of_item, patches.near.counts,
               kept.counts, kept.stale, candidates.rows, candidates.counts, candidates.others,
               corners, f.beyond, f.owned, f.ring_begin, f.ring, table.rows, table.counts,
               table.needs, table.others, c.items, kHalo, kLeast, kInstance);
}

void find_edges_case(KernelCase& c) {
    Patches patches(c);
    auto& points = add_points(c, "points", c.items + 2);
    auto& ends = add_numbers(c, "ends", 2 * c.items, c.items + 2);
    Table candidates(c, "candidates", c.items, 4);
    fill_near(c, patches, candidates, c.items);
    const Kept kept(c, patches);
    Table table = add_rows(c, "ee");
    c.launch = launch(kernels::find_edges, c.segments, points, patches.of_item, patches.near.counts,
                      kept.counts, kept.stale, candidates.rows, candidates.counts,
                      candidates.others, ends, table.rows, table.counts, table.needs, table.others,
                      c.items, kHalo, kLeast, kInstance);
}

const bool added =
    add_case("enclose_strides", enclose_strides_case) && add_case("check_candidates", check_case) &&
    add_case("collect_triangles", collect_triangles_case) &&
    add_case("collect_vertices", collect_vertices_case) &&
    add_case("collect_edges", collect_edges_case) &&
    add_case("find_triangles", find_triangles_case) &&
    add_case("find_vertices", find_vertices_case) && add_case("find_edges", find_edges_case);

}  // namespace
}  // namespace weft::test
