#include <algorithm>
#include <limits>

#include "kernels/contact/near.h"
#include "kernels/contact/pairs.h"
#include "runtime/row_table.h"
#include "tests/kernels/kernel_case.h"

namespace weft::test {
namespace {

constexpr float kHalo = 0.2f;
constexpr float kLeast = 0.02f;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Points with a reach; in degenerate cases many in one place, or in one plane.
Buffer<float4>& add_points(KernelCase& c, const std::string& name, int count) {
    auto& points = c.add<float4>(name, count);
    for (int p = 0; p < count; ++p) {
        points[at(p)] = c.random.point(0.6f);
        points[at(p)].w = c.random.real(0.0f, 0.1f);
        if (c.flavour == Flavour::kRandom) continue;
        if (p % 3 == 1) points[at(p)] = points[at(p / 4)];
        if (p % 5 == 0) points[at(p)].y = 0.0f;
    }
    return points;
}

/// Any of so many, column by column.
Buffer<int>& add_numbers(KernelCase& c, const std::string& name, int count, int of) {
    auto& numbers = c.add<int>(name, count);
    for (int& number : numbers.span()) number = c.random.integer(0, of - 1);
    return numbers;
}

/// Where lists begin; `least` to `most` long.
Buffer<int>& add_begins(KernelCase& c, const std::string& name, int count, int least, int most) {
    auto& begin = c.add<int>(name, count + 1);
    for (int n = 0; n < count; ++n) begin[at(n + 1)] = begin[at(n)] + c.random.integer(least, most);
    return begin;
}

/// Boxes with a reach, small enough to be apart now and then.
struct Boxes {
    Buffer<float4>& low;
    Buffer<float4>& high;

    Boxes(KernelCase& c, const std::string& name, int count, float size)
        : low(c.add<float4>(name + ".low", count)), high(c.add<float4>(name + ".high", count)) {
        for (int b = 0; b < count; ++b) {
            const float4 x = c.random.point(0.6f);
            const float q = c.random.real(0.0f, size);
            low[at(b)] = {x.x - q, x.y - q, x.z - q, 0.0f};
            high[at(b)] = {x.x + q, x.y + q, x.z + q, c.random.real(0.0f, 0.1f)};
        }
    }
};

void make_empty(float4& low, float4& high) {
    low = {1e30f, 1e30f, 1e30f, 0.0f};
    high = {-1e30f, -1e30f, -1e30f, 0.0f};
}

void include(float4& low, float4& high, const float4& other_low, const float4& other_high) {
    low = {std::min(low.x, other_low.x), std::min(low.y, other_low.y), std::min(low.z, other_low.z),
           0.0f};
    high = {std::max(high.x, other_high.x), std::max(high.y, other_high.y),
            std::max(high.z, other_high.z), 0.0f};
}

/// Boxes around those from begin[b] to begin[b + 1].
void enclose(Boxes& boxes, int count, const Buffer<int>& begin, const Boxes& children) {
    for (int b = 0; b < count; ++b) {
        make_empty(boxes.low[at(b)], boxes.high[at(b)]);
        for (int k = begin[at(b)]; k < begin[at(b + 1)]; ++k) {
            include(boxes.low[at(b)], boxes.high[at(b)], children.low[at(k)], children.high[at(k)]);
        }
    }
}

/// Rows to be filled, with too little room in some.
struct Table {
    Buffer<int>& rows;
    Buffer<int>& counts;
    Buffer<int>& needs;
    Buffer<int>& others;

    Table(KernelCase& c, const std::string& name, int items, int room)
        : rows(c.add<int>(name + ".rows", 2 * items)),
          counts(c.add<int>(name + ".counts", items)),
          needs(c.add<int>(name + ".needs", items)),
          others(c.add<int>(name + ".others", (items + 8) * room + 8)) {
        Buffer<int> begin("strips", 2);
        begin[1] = items;
        RowTable table("table", {&begin, 0, 1, 1}, room);
        std::copy_n(table.rows().data(), rows.count(), rows.data());
        for (int& other : others.span()) other = -1;
        for (int& count : counts.span()) count = 7;
        for (int& need : needs.span()) need = c.random.integer(0, 6);
    }
};

/// Items in patches of 1 to 5, each with some patches near to it.
struct Patches {
    int count = 0;
    Buffer<int>& of_item;
    Table near;
    Boxes boxes;

    explicit Patches(KernelCase& c)
        : of_item(c.add<int>("patches", c.items)),
          near(c, "near", c.items, 4),
          boxes(c, "patches", c.items, 1.0f) {
        for (int i = 0, left = 0; i < c.items; ++i) {
            if (left-- == 0) {
                left = c.random.integer(0, 4);
                ++count;
            }
            of_item[at(i)] = count - 1;
        }
        for (int p = 0; p < count; ++p) {
            near.counts[at(p)] = c.random.integer(0, 4);
            for (int k = 0; k < near.counts[at(p)]; ++k) {
                near.others[at(near.rows[at(p)] + RowTable::kStride * k)] =
                    std::min(p + 2 * k, count - 1);
            }
        }
    }
};

void place_points_case(KernelCase& c) {
    auto& anchors = add_points(c, "anchors", c.items + 3);
    auto& vertices = add_numbers(c, "vertices", c.items, c.items + 3);
    auto& points = c.add<float4>("points", c.items);
    c.launch = launch(kernels::place_points, c.segments, anchors, vertices, points);
}

void enclose_patches_case(KernelCase& c) {
    auto& anchors = add_points(c, "anchors", 20);
    auto& begin = add_begins(c, "begin", c.items, 1, 12);
    auto& hulls = add_numbers(c, "hulls", begin[at(c.items)], 20);
    auto& low = c.add<float4>("low", c.items);
    auto& high = c.add<float4>("high", c.items);
    c.launch = launch(kernels::enclose_patches, c.segments, anchors, begin, hulls, low, high,
                      0.5f * kHalo);
}

void enclose_boxes_case(KernelCase& c) {
    auto& begin = add_begins(c, "begin", c.items, 0, 8);
    Boxes children(c, "children", begin[at(c.items)] + 1, 0.3f);
    auto& low = c.add<float4>("low", c.items);
    auto& high = c.add<float4>("high", c.items);
    c.launch =
        launch(kernels::enclose_boxes, c.segments, begin, children.low, children.high, low, high);
}

/// Triangles that face up, more or less; in degenerate cases all ways, and collapsed.
void tilt_patches_case(KernelCase& c) {
    auto& anchors = add_points(c, "anchors", 30);
    const bool is_random = c.flavour == Flavour::kRandom;
    for (int p = 0; p < 30 && is_random; ++p) {
        anchors[at(p)] = {0.1f * static_cast<float>(p % 6), c.random.real(0.0f, 0.05f),
                          0.1f * static_cast<float>(p / 6), c.random.real(0.0f, 0.04f)};
    }
    auto& begin = add_begins(c, "begin", c.items, 1, 6);
    const int faces = begin[at(c.items)];
    auto& corners = c.add<int>("corners", 3 * faces);
    for (int f = 0; f < faces; ++f) {
        const int cell = 6 * c.random.integer(0, 3) + c.random.integer(0, 4);
        corners[at(f)] = is_random ? cell : c.random.integer(0, 29);
        corners[at(f + faces)] = is_random ? cell + 6 : c.random.integer(0, 29);
        corners[at(f + 2 * faces)] = is_random ? cell + 1 : c.random.integer(0, 29);
    }
    Boxes boxes(c, "boxes", c.items, 0.1f);
    auto& quiet = c.add<float>("quiet", c.items);
    for (float& limit : quiet.span()) limit = c.random.real(0.02f, 0.06f);
    auto& goals = c.add<float4>("goals", 30);
    for (int p = 0; p < 30; ++p) {
        const float4 off = c.random.point(0.006f);
        goals[at(p)] = {anchors[at(p)].x + off.x + 0.1f, anchors[at(p)].y + off.y,
                        anchors[at(p)].z + off.z, 1.0f};
    }
    auto& foresees = add_numbers(c, "foresees", 1, 2);
    auto& tilts = c.add<float4>("tilts", c.items);
    auto& drifts = c.add<float4>("drifts", c.items);
    c.launch = launch(kernels::tilt_patches, c.segments, anchors, goals, foresees, begin, corners,
                      boxes.high, quiet, tilts, drifts, faces);
}

void enclose_primitives_case(KernelCase& c) {
    Patches patches(c);
    auto& points = add_points(c, "points", 20);
    auto& corners = add_numbers(c, "corners", 3 * c.items, 20);
    auto& low = c.add<float4>("low", c.items);
    auto& high = c.add<float4>("high", c.items);
    c.launch = launch(kernels::enclose_primitives, c.segments, points, corners, patches.of_item,
                      patches.near.counts, low, high, 0.5f * kHalo, 3, c.items);
}

/// Boxes of a level, each around three of the next one.
struct Level {
    Buffer<int>& begin;
    Boxes boxes;
    int count;

    Level(KernelCase& c, const std::string& name, int child_count, const Boxes& children)
        : begin(c.add<int>(name + ".begin", child_count / 3 + 2)),
          boxes(c, name, child_count / 3 + 1, 0.0f),
          count(child_count / 3 + 1) {
        for (int b = 0; b <= count; ++b) begin[at(b)] = std::min(3 * b, child_count);
        enclose(boxes, count, begin, children);
    }
};

void near_case(KernelCase& c) {
    Boxes boxes(c, "boxes", c.items, 0.3f);
    Level groups(c, "groups", c.items, boxes);
    Level blocks(c, "blocks", groups.count, groups.boxes);
    Level roots(c, "roots", blocks.count, blocks.boxes);
    auto& tilts = c.add<float4>("tilts", c.items);
    for (float4& tilt : tilts.span()) {
        tilt = {0.0f, c.random.integer(0, 3) == 0 ? -1.0f : 1.0f, 0.0f,
                static_cast<float>(c.random.integer(0, 2))};
    }
    auto& drifts = add_points(c, "drifts", c.items);
    for (float4& drift : drifts.span()) drift.w = c.random.real(0.0f, 1.0f);
    auto& begin = add_begins(c, "beside.begin", c.items, 1, 9);
    auto& beside = add_numbers(c, "beside", begin[at(c.items)], c.items);
    auto& vias = add_numbers(c, "vias", begin[at(c.items)], c.items);
    for (int p = 0; p < c.items; ++p) {
        std::sort(beside.data() + begin[at(p)], beside.data() + begin[at(p + 1)]);
        beside[at(begin[at(p + 1)] - 1)] = std::numeric_limits<int>::max();
    }
    auto& bodies = add_numbers(c, "bodies", c.items, 3);
    auto& held = add_numbers(c, "held", c.items, 2);
    Table table(c, "near", c.items, 3);
    c.launch =
        launch(kernels::find_near_patches, c.segments, roots.boxes.low, roots.boxes.high,
               roots.begin, blocks.boxes.low, blocks.boxes.high, blocks.begin, groups.boxes.low,
               groups.boxes.high, groups.begin, boxes.low, boxes.high, tilts, drifts, begin, beside,
               vias, bodies, held, table.rows, table.counts, table.needs, table.others, c.items,
               roots.count, c.flavour == Flavour::kRandom ? 1 : 0, kInstance);
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

void find_triangles_case(KernelCase& c) {
    Patches patches(c);
    auto& points = add_points(c, "points", c.items);
    auto& begin = add_begins(c, "triangles.begin", patches.count, 0, 6);
    const int triangles = begin[at(patches.count)];
    auto& corners = add_numbers(c, "corners", 3 * triangles, c.items);
    Boxes boxes(c, "boxes", triangles, 0.6f);
    enclose(patches.boxes, patches.count, begin, boxes);
    auto& knots = add_numbers(c, "knots", c.items, c.items);
    Features f(c, c.items, triangles);
    Table table(c, "vt", c.items, 3);
    c.launch = launch(kernels::find_triangles, c.segments, points, patches.of_item,
                      patches.near.rows, patches.near.counts, patches.near.others,
                      patches.boxes.low, patches.boxes.high, begin, corners, knots, boxes.low,
                      boxes.high, f.beyond, f.owned, f.ring_begin, f.ring, table.rows, table.counts,
                      table.needs, table.others, c.items, triangles, kHalo, kLeast, kInstance);
}

void find_vertices_case(KernelCase& c) {
    Patches patches(c);
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
    Features f(c, vertices, c.items);
    Table table(c, "tv", c.items, 3);
    c.launch = launch(kernels::find_vertices, c.segments, points, patches.of_item,
                      patches.near.rows, patches.near.counts, patches.near.others,
                      patches.boxes.low, patches.boxes.high, begin, corners, knots, boxes.low,
                      boxes.high, f.beyond, f.owned, f.ring_begin, f.ring, table.rows, table.counts,
                      table.needs, table.others, c.items, kHalo, kLeast, kInstance);
}

void find_edges_case(KernelCase& c) {
    Patches patches(c);
    auto& begin = c.add<int>("edges.begin", patches.count + 1);
    for (int i = 0; i < c.items; ++i) begin[at(patches.of_item[at(i)] + 1)] = i + 1;
    auto& points = add_points(c, "points", c.items + 2);
    auto& ends = add_numbers(c, "ends", 2 * c.items, c.items + 2);
    auto& knots = add_numbers(c, "knots", c.items + 2, c.items + 2);
    Boxes boxes(c, "boxes", c.items, 0.6f);
    enclose(patches.boxes, patches.count, begin, boxes);
    Table table(c, "ee", c.items, 3);
    c.launch = launch(kernels::find_edges, c.segments, points, patches.of_item, patches.near.rows,
                      patches.near.counts, patches.near.others, patches.boxes.low,
                      patches.boxes.high, begin, ends, knots, boxes.low, boxes.high, table.rows,
                      table.counts, table.needs, table.others, c.items, kHalo, kLeast, kInstance);
}

const bool added =
    add_case("place_points", place_points_case) &&
    add_case("enclose_patches", enclose_patches_case) &&
    add_case("enclose_boxes", enclose_boxes_case) && add_case("tilt_patches", tilt_patches_case) &&
    add_case("enclose_primitives", enclose_primitives_case) &&
    add_case("find_near_patches", near_case) && add_case("find_triangles", find_triangles_case) &&
    add_case("find_vertices", find_vertices_case) && add_case("find_edges", find_edges_case);

}  // namespace
}  // namespace weft::test
