#include "simulation/contact/pairs.h"

#include <algorithm>

#include "kernels/contact/gates.h"
#include "kernels/contact/near.h"
#include "kernels/contact/pairs.h"
#include "kernels/contact/tilts.h"

namespace weft {

namespace {

using Items = SurfaceBuffers::Items;

/// Launches take buffers as what they are.
Buffer<int>& plain(SurfaceBuffers::Ints& buffer) { return buffer; }
template <class Value>
Value&& plain(Value&& value) {
    return std::forward<Value>(value);
}

template <class Kernel, class... Values>
Launch launch_on(Kernel kernel, const Items& items, Values&&... values) {
    return launch(kernel, items.segments, plain(values)...);
}

/// At least one, so that devices have something to hold.
std::size_t size_of(const Items& items) {
    return static_cast<std::size_t>(std::max(items.count(), 1));
}

/// The items of a part, and of the strips up to `end`.
std::pair<int, int> range(const Items& items, int begin, int end) {
    return {items.segments.item(begin), items.segments.item(end)};
}

template <class Buffer>
void updates(Step::Adding adding, Buffer& buffer, const Items& items, const Part& part) {
    const auto [first, last] = range(items, part.begin, part.end);
    adding.updates(buffer, first, last);
}

template <class Buffer>
void reads_all(Step::Adding adding, Buffer& buffer, const Items& items) {
    adding.reads(buffer, 0, items.count());
}

void fills(Step::Adding adding, PairTable& rows, const Items& items, const Part& part) {
    const auto [first, last] = range(items, part.begin, part.end);
    rows.add_fills(adding, first, last);
}

}  // namespace

ContactPairs::ContactPairs(Surface surface, const std::vector<Vec3>& rest, Buffer<float4>& anchors,
                           Buffer<float4>& goals, Buffer<float4>& strides, const Segments& strips,
                           const PairSettings& settings, int first_kind)
    : surface_(std::move(surface)),
      s_(surface_, rest),
      settings_(settings),
      halo_(0.5f * settings.thickness),
      anchors_(anchors),
      goals_(goals),
      strides_(strides),
      strips_(strips),
      points_("contact.points", size_of(s_.vertices.items)),
      worn_("contact.worn", size_of(s_.patches)),
      tilts_("contact.tilts", size_of(s_.patches)),
      drifts_("contact.drifts", size_of(s_.patches)),
      group_tilts_("contact.groups.tilts", size_of(s_.groups.items)),
      group_opens_("contact.groups.opens", size_of(s_.groups.items)),
      near_strips_("contact.near_strips", size_of(s_.roots.items)),
      awake_("contact.awake", size_of(s_.roots.items)),
      patch_low_("contact.patches.low", size_of(s_.patches)),
      patch_high_("contact.patches.high", size_of(s_.patches)),
      slant_low_("contact.patches.slant_low", 2 * size_of(s_.patches)),
      slant_high_("contact.patches.slant_high", 2 * size_of(s_.patches)),
      group_slant_low_("contact.groups.slant_low", 2 * size_of(s_.groups.items)),
      group_slant_high_("contact.groups.slant_high", 2 * size_of(s_.groups.items)),
      triangle_low_("contact.triangles.low", size_of(s_.triangles.items)),
      triangle_high_("contact.triangles.high", size_of(s_.triangles.items)),
      edge_low_("contact.edges.low", size_of(s_.edges.items)),
      edge_high_("contact.edges.high", size_of(s_.edges.items)),
      near_("contact.near", s_.patches.segments, 8 * settings.room),
      vt_("contact.vt", s_.vertices.items.segments, 2 * settings.room),
      tv_("contact.tv", s_.triangles.items.segments, settings.room),
      ee_("contact.ee", s_.edges.items.segments, 2 * settings.room),
      candidates_(s_, strides, settings.thickness, settings.room) {
    make_boxes_body(first_kind);
    make_near_body(first_kind + 1);
    make_pairs_body(first_kind + 2);
}

std::vector<RowTable*> ContactPairs::tables() {
    auto list = candidates_.tables();
    list.insert(list.begin(), &near_.table);
    list.insert(list.end(), {&vt_.table, &tv_.table, &ee_.table});
    return list;
}

void ContactPairs::make_boxes_body(int kind) {
    const auto unite = [&](SurfaceBuffers::Level& level, Buffer<float4>& low,
                           Buffer<float4>& high) {
        return launch_on(kernels::enclose_boxes, level.items, level.children, low, high, level.low,
                         level.high);
    };
    const float margin = 0.5f * halo_;
    boxes_ = {
        "boxes",
        kind,
        {launch_on(kernels::place_points, s_.vertices.items, anchors_, s_.model_vertices, points_),
         launch_on(kernels::enclose_patches, s_.patches, anchors_, s_.hulls.begin, s_.hulls.items,
                   patch_low_, patch_high_, slant_low_, slant_high_, margin,
                   surface_.patch_count()),
         launch_on(kernels::tilt_patches, s_.patches, anchors_, goals_, strides_, foresees_,
                   s_.face_begin, s_.face_corners, s_.rims.begin, s_.rims.items, patch_high_,
                   s_.quiet, worn_, tilts_, drifts_, surface_.faces.begin.back(), kInstance),
         launch_on(kernels::tilt_groups, s_.groups.items, s_.groups.children, tilts_, group_tilts_),
         candidates_.enclose(), unite(s_.groups, patch_low_, patch_high_),
         launch_on(kernels::enclose_slants, s_.groups.items, s_.groups.children, slant_low_,
                   slant_high_, group_slant_low_, group_slant_high_, surface_.patch_count(),
                   s_.groups.items.count()),
         unite(s_.blocks, s_.groups.low, s_.groups.high),
         unite(s_.roots, s_.blocks.low, s_.blocks.high)}};
}

void ContactPairs::make_near_body(int kind) {
    RowTable& table = near_.table;
    const float margin = 0.5f * halo_;
    near_task_ = {
        "near",
        kind,
        {launch_on(kernels::find_open_groups, s_.groups.items, s_.roots.low, s_.roots.high,
                   s_.roots.children, s_.blocks.low, s_.blocks.high, s_.blocks.children,
                   s_.groups.low, s_.groups.high, group_slant_low_, group_slant_high_, group_tilts_,
                   s_.group_beside_begin, s_.group_besides, s_.group_vias, group_opens_,
                   s_.groups.items.count(), surface_.strip_count(), candidates_.margin()),
         launch_on(kernels::find_near_patches, s_.patches, s_.roots.low, s_.roots.high,
                   s_.roots.children, s_.blocks.low, s_.blocks.high, s_.blocks.children,
                   s_.groups.low, s_.groups.high, group_slant_low_, group_slant_high_,
                   s_.groups.children, patch_low_, patch_high_, slant_low_, slant_high_, tilts_,
                   drifts_, s_.beside_begin, s_.besides, s_.vias, s_.group_of, group_opens_,
                   group_tilts_, s_.group_beside_begin, s_.group_besides, s_.group_vias, s_.bodies,
                   s_.held, table.rows(), table.counts(), table.needs(), near_.others,
                   surface_.patch_count(), s_.groups.items.count(), surface_.strip_count(),
                   candidates_.margin(), settings_.self ? 1 : 0, kInstance),
         candidates_.check(near_, {patch_low_, patch_high_, slant_low_, slant_high_}),
         launch_on(kernels::find_awake_strips, s_.roots.items, s_.patches.begin, table.counts(),
                   candidates_.kept(), candidates_.stale(), near_strips_, awake_, kInstance),
         only_where(awake_,
                    launch_on(kernels::enclose_primitives, s_.triangles.items, points_, s_.corners,
                              s_.triangles.patches, table.counts(), triangle_low_, triangle_high_,
                              margin, 3, surface_.triangle_count())),
         only_where(awake_, launch_on(kernels::enclose_primitives, s_.edges.items, points_, s_.ends,
                                      s_.edges.patches, table.counts(), edge_low_, edge_high_,
                                      margin, 2, surface_.edge_count()))}};
}

void ContactPairs::make_pairs_body(int kind) {
    pairs_ = {"pairs", kind, {}};
    add_collecting(pairs_.launches);
    add_choosing(pairs_.launches);
}

/// Of patches whose candidates do not last any longer.
void ContactPairs::add_collecting(std::vector<Launch>& launches) {
    const auto add = [&](auto kernel, SurfaceBuffers::Patched& items, PairTable& candidates,
                         SurfaceBuffers::Patched& others, SurfaceBuffers::Ints& corners,
                         Buffer<float4>& low, Buffer<float4>& high, auto... numbers) {
        launches.push_back(only_where(
            awake_,
            launch_on(kernel, items.items, points_, items.patches, near_.table.rows(),
                      near_.table.counts(), near_.others, candidates_.stale(), candidates_.slacks(),
                      patch_low_, patch_high_, others.begin, corners, s_.knots, low, high,
                      candidates.table.rows(), candidates.table.counts(), candidates.table.needs(),
                      candidates.others, numbers..., std::max(halo_, settings_.least),
                      candidates_.spare(), kInstance)));
    };
    add(kernels::collect_triangles, s_.vertices, candidates_.triangles(), s_.triangles, s_.corners,
        triangle_low_, triangle_high_, surface_.vertex_count(), surface_.triangle_count(), halo_);
    add(kernels::collect_vertices, s_.triangles, candidates_.vertices(), s_.vertices, s_.corners,
        triangle_low_, triangle_high_, surface_.triangle_count(), halo_);
    add(kernels::collect_edges, s_.edges, candidates_.edges(), s_.edges, s_.ends, edge_low_,
        edge_high_, surface_.edge_count());
}

/// Of what is a pair in this substep.
void ContactPairs::add_choosing(std::vector<Launch>& launches) {
    const auto add = [&](auto kernel, SurfaceBuffers::Patched& items, PairTable& candidates,
                         auto&&... values) {
        launches.push_back(only_where(
            awake_, launch_on(kernel, items.items, points_, items.patches, near_.table.counts(),
                              candidates_.kept(), candidates_.stale(), candidates.table.rows(),
                              candidates.table.counts(), candidates.others, values...)));
    };
    add(kernels::find_triangles, s_.vertices, candidates_.triangles(), s_.corners, s_.beyond,
        s_.owned, s_.ring.begin, s_.ring.items, vt_.table.rows(), vt_.table.counts(),
        vt_.table.needs(), vt_.others, surface_.vertex_count(), surface_.triangle_count(), halo_,
        settings_.least, kInstance);
    add(kernels::find_vertices, s_.triangles, candidates_.vertices(), s_.corners, s_.beyond,
        s_.owned, s_.ring.begin, s_.ring.items, tv_.table.rows(), tv_.table.counts(),
        tv_.table.needs(), tv_.others, surface_.triangle_count(), halo_, settings_.least,
        kInstance);
    add(kernels::find_edges, s_.edges, candidates_.edges(), s_.ends, ee_.table.rows(),
        ee_.table.counts(), ee_.table.needs(), ee_.others, surface_.edge_count(), halo_,
        settings_.least, kInstance);
}

/// The triangles of a strip reach into the next one.
void ContactPairs::add_boxes(Step& step, const Part& part, RegionId region) {
    const int next = std::min(part.end + 1, strips_.strip_count);
    auto adding = step.add(boxes_, 0, part.strips(), region);
    adding.reads(anchors_, strips_.item(part.begin), strips_.item(next));
    adding.reads(goals_, strips_.item(part.begin), strips_.item(next));
    updates(adding, points_, s_.vertices.items, part);
    const auto [first_patch, last_patch] = range(s_.patches, part.begin, part.end);
    candidates_.add_enclose_accesses(adding, strips_.item(part.begin), strips_.item(next),
                                     first_patch, last_patch);
    updates(adding, worn_, s_.patches, part);
    updates(adding, tilts_, s_.patches, part);
    updates(adding, drifts_, s_.patches, part);
    updates(adding, group_tilts_, s_.groups.items, part);
    updates(adding, patch_low_, s_.patches, part);
    updates(adding, patch_high_, s_.patches, part);
    const auto updates_halves = [&](Buffer<float4>& slants, const Items& items) {
        const auto [first, last] = range(items, part.begin, part.end);
        adding.updates(slants, first, last)
            .updates(slants, items.count() + first, items.count() + last);
    };
    for (Buffer<float4>* slants : {&slant_low_, &slant_high_}) updates_halves(*slants, s_.patches);
    for (Buffer<float4>* slants : {&group_slant_low_, &group_slant_high_}) {
        updates_halves(*slants, s_.groups.items);
    }
    for (SurfaceBuffers::Level* level : {&s_.groups, &s_.blocks, &s_.roots}) {
        updates(adding, level->low, level->items, part);
        updates(adding, level->high, level->items, part);
    }
}

void ContactPairs::add_near(Step& step, const Part& part, RegionId region) {
    const int next = std::min(part.end + 1, strips_.strip_count);
    const auto [first, last] = range(s_.vertices.items, part.begin, next);
    auto adding = step.add(near_task_, 0, part.strips(), region);
    reads_all(adding, tilts_, s_.patches);
    reads_all(adding, drifts_, s_.patches);
    reads_all(adding, group_tilts_, s_.groups.items);
    reads_all(adding, patch_low_, s_.patches);
    reads_all(adding, patch_high_, s_.patches);
    adding.reads(slant_low_, 0, 2 * surface_.patch_count())
        .reads(slant_high_, 0, 2 * surface_.patch_count())
        .reads(group_slant_low_, 0, 2 * s_.groups.items.count())
        .reads(group_slant_high_, 0, 2 * s_.groups.items.count());
    for (SurfaceBuffers::Level* level : {&s_.groups, &s_.blocks, &s_.roots}) {
        reads_all(adding, level->low, level->items);
        reads_all(adding, level->high, level->items);
    }
    adding.reads(points_, first, last);
    updates(adding, group_opens_, s_.groups.items, part);
    fills(adding, near_, s_.patches, part);
    const auto [first_patch, last_patch] = range(s_.patches, part.begin, part.end);
    candidates_.add_check_accesses(adding, first_patch, last_patch);
    adding.updates(near_strips_, part.begin, part.end).updates(awake_, part.begin, part.end);
    updates(adding, triangle_low_, s_.triangles.items, part);
    updates(adding, triangle_high_, s_.triangles.items, part);
    updates(adding, edge_low_, s_.edges.items, part);
    updates(adding, edge_high_, s_.edges.items, part);
}

void ContactPairs::add_pairs(Step& step, const Part& part, RegionId region) {
    const auto [first, last] = range(s_.patches, part.begin, part.end);
    auto adding = step.add(pairs_, 0, part.strips(), region);
    reads_all(adding, patch_low_, s_.patches);
    reads_all(adding, patch_high_, s_.patches);
    reads_all(adding, points_, s_.vertices.items);
    reads_all(adding, triangle_low_, s_.triangles.items);
    reads_all(adding, triangle_high_, s_.triangles.items);
    reads_all(adding, edge_low_, s_.edges.items);
    reads_all(adding, edge_high_, s_.edges.items);
    adding.reads(awake_, part.begin, part.end)
        .reads(near_.table.counts(), first, last)
        .reads(near_.others, near_.table.entries())
        .reads(candidates_.kept(), first, last)
        .reads(candidates_.stale(), first, last)
        .reads(candidates_.slacks(), first, last);
    fills(adding, candidates_.triangles(), s_.vertices.items, part);
    fills(adding, candidates_.vertices(), s_.triangles.items, part);
    fills(adding, candidates_.edges(), s_.edges.items, part);
    fills(adding, vt_, s_.vertices.items, part);
    fills(adding, tv_, s_.triangles.items, part);
    fills(adding, ee_, s_.edges.items, part);
}

}  // namespace weft
