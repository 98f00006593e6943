#include <algorithm>
#include <limits>

#include "kernels/contact/near.h"
#include "kernels/contact/tilts.h"
#include "tests/kernels/contact_case_parts.h"

namespace weft::test {
namespace {

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
    auto& slant_low = c.add<float4>("slant_low", 2 * c.items);
    auto& slant_high = c.add<float4>("slant_high", 2 * c.items);
    c.launch = launch(kernels::enclose_patches, c.segments, anchors, begin, hulls, low, high,
                      slant_low, slant_high, 0.5f * kHalo, c.items);
}

void enclose_boxes_case(KernelCase& c) {
    auto& begin = add_begins(c, "begin", c.items, 0, 8);
    Boxes children(c, "children", begin[at(c.items)] + 1, 0.3f);
    auto& low = c.add<float4>("low", c.items);
    auto& high = c.add<float4>("high", c.items);
    c.launch =
        launch(kernels::enclose_boxes, c.segments, begin, children.low, children.high, low, high);
}

void enclose_slants_case(KernelCase& c) {
    auto& begin = add_begins(c, "begin", c.items, 0, 8);
    const int children = begin[at(c.items)] + 1;
    Boxes slants(c, "slants", 2 * children, 0.3f);
    auto& low = c.add<float4>("low", 2 * c.items);
    auto& high = c.add<float4>("high", 2 * c.items);
    c.launch = launch(kernels::enclose_slants, c.segments, begin, slants.low, slants.high, low,
                      high, children, c.items);
}

/// Triangles that face up, more or less; in degenerate cases all ways, and collapsed.
void tilt_patches_case(KernelCase& c) {
    auto& anchors = add_points(c, "anchors", 30);
    const bool is_random = c.flavour == Flavour::kRandom;
    for (int p = 0; p < 30 && is_random; ++p) {
        anchors[at(p)] = {0.1f * static_cast<float>(p % 6), c.random.real(0.0f, 0.05f),
                          0.1f * static_cast<float>(p / 6), c.random.real(0.0f, 0.04f)};
    }
    // Some have more than what is kept of a patch.
    const bool has_many = c.random.integer(0, 2) == 0;
    auto& begin = add_begins(c, "begin", c.items, 1, has_many ? 2 * WEFT_KEPT : 6);
    auto& rim_begin = add_begins(c, "rim_begin", c.items, 0, has_many ? 2 * WEFT_KEPT : 8);
    auto& rims = add_numbers(c, "rims", rim_begin[at(c.items)] + 1, 30);
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
    auto& strides = c.add<float4>("strides", 30);
    for (float4& stride : strides.span()) stride = c.random.point(0.01f);
    auto& worn = c.add<float>("worn", c.items);
    for (float& way : worn.span()) way = c.random.real(0.0f, 0.03f);
    auto& tilts = c.add<float4>("tilts", c.items);
    for (float4& tilt : tilts.span()) tilt.w = static_cast<float>(c.random.integer(0, 2));
    auto& drifts = c.add<float4>("drifts", c.items);
    c.launch =
        launch(kernels::tilt_patches, c.segments, anchors, goals, strides, foresees, begin, corners,
               rim_begin, rims, boxes.high, quiet, worn, tilts, drifts, faces, kInstance);
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

/// Some flat, most of these facing one way, and which of them hang together.
struct GroupsBeside {
    Buffer<float4>& tilts;
    Buffer<int>& begin;
    Buffer<int>& besides;
    Buffer<int>& vias;

    GroupsBeside(KernelCase& c, int groups)
        : tilts(c.add<float4>("groups.tilts", groups)),
          begin(add_begins(c, "groups.beside.begin", groups, 1, 9)),
          besides(add_numbers(c, "groups.besides", begin[at(groups)], groups)),
          vias(add_numbers(c, "groups.vias", begin[at(groups)], groups)) {
        for (float4& tilt : tilts.span()) {
            tilt = {0.0f, c.random.integer(0, 3) == 0 ? -1.0f : 1.0f, 0.0f,
                    static_cast<float>(c.random.integer(0, 3) > 0)};
        }
        for (int g = 0; g < groups; ++g) {
            std::sort(besides.data() + begin[at(g)], besides.data() + begin[at(g + 1)]);
            besides[at(begin[at(g + 1)] - 1)] = std::numeric_limits<int>::max();
        }
    }
};

void tilt_groups_case(KernelCase& c) {
    auto& begin = add_begins(c, "begin", c.items, 0, 8);
    auto& patch_tilts = c.add<float4>("patch_tilts", begin[at(c.items)] + 1);
    for (float4& tilt : patch_tilts.span()) {
        tilt = c.random.point(0.3f);
        tilt.y = c.random.integer(0, 20) == 0 ? -1.0f : 1.0f;
        tilt.w = static_cast<float>(1 + c.random.integer(0, 20) / 20);
    }
    auto& tilts = c.add<float4>("tilts", c.items);
    c.launch = launch(kernels::tilt_groups, c.segments, begin, patch_tilts, tilts);
}

void open_groups_case(KernelCase& c) {
    Boxes boxes(c, "boxes", c.items, 0.3f);
    Level blocks(c, "blocks", c.items, boxes);
    Level roots(c, "roots", blocks.count, blocks.boxes);
    Boxes slants(c, "slants", 2 * c.items, 2.0f);
    GroupsBeside beside(c, c.items);
    auto& opens = c.add<int>("opens", c.items);
    c.launch = launch(kernels::find_open_groups, c.segments, roots.boxes.low, roots.boxes.high,
                      roots.begin, blocks.boxes.low, blocks.boxes.high, blocks.begin, boxes.low,
                      boxes.high, slants.low, slants.high, beside.tilts, beside.begin,
                      beside.besides, beside.vias, opens, c.items, roots.count, 0.1f);
}

void near_case(KernelCase& c) {
    Boxes boxes(c, "boxes", c.items, 0.3f);
    Boxes slants(c, "slants", 2 * c.items, 2.0f);
    Level groups(c, "groups", c.items, boxes);
    Boxes group_slants(c, "groups.slants", 2 * groups.count, 2.0f);
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
    GroupsBeside beside_groups(c, groups.count);
    auto& group_of = c.add<int>("group_of", c.items);
    for (int g = 0; g < groups.count; ++g) {
        for (int p = groups.begin[at(g)]; p < groups.begin[at(g + 1)]; ++p) group_of[at(p)] = g;
    }
    auto& opens = add_numbers(c, "opens", groups.count, 2);
    auto& bodies = add_numbers(c, "bodies", c.items, 3);
    auto& held = add_numbers(c, "held", c.items, 2);
    Table table(c, "near", c.items, 3);
    c.launch = launch(kernels::find_near_patches, c.segments, roots.boxes.low, roots.boxes.high,
                      roots.begin, blocks.boxes.low, blocks.boxes.high, blocks.begin,
                      groups.boxes.low, groups.boxes.high, group_slants.low, group_slants.high,
                      groups.begin, boxes.low, boxes.high, slants.low, slants.high, tilts, drifts,
                      begin, beside, vias, group_of, opens, beside_groups.tilts,
                      beside_groups.begin, beside_groups.besides, beside_groups.vias, bodies, held,
                      table.rows, table.counts, table.needs, table.others, c.items, groups.count,
                      roots.count, 0.1f, c.flavour == Flavour::kRandom ? 1 : 0, kInstance);
}

const bool added =
    add_case("place_points", place_points_case) &&
    add_case("enclose_patches", enclose_patches_case) &&
    add_case("enclose_boxes", enclose_boxes_case) &&
    add_case("enclose_slants", enclose_slants_case) &&
    add_case("tilt_patches", tilt_patches_case) && add_case("tilt_groups", tilt_groups_case) &&
    add_case("enclose_primitives", enclose_primitives_case) &&
    add_case("find_open_groups", open_groups_case) && add_case("find_near_patches", near_case);

}  // namespace
}  // namespace weft::test
