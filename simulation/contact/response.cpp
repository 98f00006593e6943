#include "simulation/contact/response.h"

#include <algorithm>
#include <numeric>

#include "kernels/contact/begin.h"
#include "kernels/contact/fences.h"
#include "kernels/contact/fill.h"
#include "kernels/contact/gates.h"
#include "kernels/contact/quiet.h"
#include "kernels/contact/rows.h"
#include "kernels/contact/truncate.h"
#include "runtime/executor.h"
#include "simulation/contact/stiffness.h"
#include "simulation/families/convert.h"
#include "simulation/model/contact_thickness.h"
#include "simulation/model/reach.h"

namespace weft {

namespace {

// In parts of the thickness.
constexpr float kMargin = 0.25f;  ///< by which vertices may go farther than inertia leads them

// Of a row.
constexpr int kFirstPairs = 8;
constexpr int kFewest = 4;  ///< contacts and planes; in small scenes more, as it costs little:
constexpr int kMost = 27;   ///< not a power of 2, lest rows crowd in a few sets of a cache

/// bytes  of an entry
int first_room(const Model& model, std::size_t bytes) {
    const std::size_t all = bytes * model.positions->count();
    return std::clamp(static_cast<int>(RowTable::kPlenty / 4 / all), kFewest, kMost);
}

std::size_t strips_of(const Model& model) { return static_cast<std::size_t>(model.strips.count()); }

/// The least of what its patches say; huge inside of bodies.
std::vector<float> quiet_of_vertices(const Surface& surface, const Buffer<float>& patches,
                                     std::size_t vertex_count) {
    std::vector<float> quiet(vertex_count, 1e30f);
    for (int p = 0; p < surface.patch_count(); ++p) {
        for (const int t : surface.faces[p]) {
            for (const int v : surface.triangles[static_cast<std::size_t>(t)]) {
                float& least =
                    quiet[static_cast<std::size_t>(surface.vertices[static_cast<std::size_t>(v)])];
                least = std::min(least, patches[static_cast<std::size_t>(p)]);
            }
        }
    }
    return quiet;
}

}  // namespace

std::unique_ptr<ContactResponse> ContactResponse::of(Model& model, int first_kind) {
    if (!model.scene.contact || model.triangles.empty()) return nullptr;
    return std::unique_ptr<ContactResponse>(new ContactResponse(model, first_kind));
}

ContactResponse::ContactResponse(Model& model, int first_kind)
    : model_(model),
      range_(static_cast<float>(model.scene.contact->thickness)),
      floor_(static_cast<float>(
          contact_floor(model.scene.contact->thickness, reach_of(model.positions->span())))),
      friction_(static_cast<float>(rubbing_of(model).friction)),
      creep_(static_cast<float>(rubbing_of(model).creep)),
      anchors_("contact.anchors", model.positions->count()),
      strides_("contact.strides", model.positions->count()),
      goals_("contact.goals", model.positions->count()),
      stiffness_("contact.stiffness", 2 * model.positions->count()),
      pairs_(make_surface(surface_of(model, model.scene.contact->thickness), model.strips),
             rest_of(model), anchors_, goals_, strides_, model.vertices(),
             {range_, floor_, model.scene.contact->self, kFirstPairs}, first_kind),
      motion_(model, pairs_.surface(), model.scene.contact->thickness,
              2.0 * double{kMargin} * model.scene.contact->thickness, pairs_.foresees()),
      quiet_("contact.quiet_vertices", model.positions->count()),
      incidence_(pairs_.surface()),
      busy_("contact.busy", pairs_.buffers().bodies.count()),
      touching_("contact.touching", strips_of(model)),
      meeting_("contact.meeting", strips_of(model)),
      filling_("contact.filling", strips_of(model)),
      fill_kind_(first_kind + static_cast<int>(ContactPairs::kinds().size())),
      truncation_(model, first_room(model, sizeof(float4)), floor_, anchors_, touching_),
      contacts_("contact.contacts", model.vertices(), first_room(model, 5 * sizeof(float4))),
      corner0_(contacts_.add_column<int>("corner0")),
      corner1_(contacts_.add_column<int>("corner1")),
      corner2_(contacts_.add_column<int>("corner2")),
      corner3_(contacts_.add_column<int>("corner3")),
      normals_(contacts_.add_column<float4>("normals")),
      weights_(contacts_.add_column<float4>("weights")),
      measures_(contacts_.add_column<float4>("measures")),
      slips_(friction_ > 0.0f ? contacts_.add_column<float4>("slips") : normals_),
      sticking_(friction_ > 0.0f ? std::make_unique<Sticking>(model, rows(), rubbing()) : nullptr),
      account_(model, range_),
      insides_(model.obstacles ? std::make_unique<Insides>(model) : nullptr),
      snapshots_("contact.snapshots", 2 * model.positions->count()),
      energy_(model, rows(), sticking_.get(), fill_kind_ + 1) {
    const auto [of_all, between_sheets] = contact_stiffness(model);
    std::ranges::copy(of_all, stiffness_.data());
    std::ranges::copy(between_sheets, stiffness_.data() + of_all.size());
    std::ranges::copy(quiet_of_vertices(pairs_.surface(), pairs_.buffers().quiet, quiet_.count()),
                      quiet_.data());
    make_fill();
}

void ContactResponse::make_fill() {
    const auto factor = static_cast<float>(model_.scene.contact->stiffness);
    auto& vt = pairs_.vt();
    auto& tv = pairs_.tv();
    auto& ee = pairs_.ee();
    RowTable& planes = truncation_.table();
    SurfaceBuffers& surface = pairs_.buffers();
    fill_ = {
        "contacts",
        fill_kind_,
        {launch(kernels::find_touching_strips, surface.roots.items.segments, pairs_.near_strips(),
                touching_, meeting_, filling_, truncation_.apart(), model_.strips.count(),
                kInstance),
         only_where(filling_, launch(kernels::find_busy_patches, surface.patches.segments,
                                     static_cast<Buffer<int>&>(surface.around.begin),
                                     static_cast<Buffer<int>&>(surface.around.items),
                                     pairs_.near().table.counts(), busy_, kInstance)),
         only_where(
             filling_,
             launch(kernels::fill_contacts, surface.vertices.items.segments, anchors_, goals_,
                    stiffness_, incidence_.apexes, incidence_.triangle_begin,
                    incidence_.triangle_list, incidence_.edge_begin, incidence_.edge_list,
                    incidence_.triangles, incidence_.edges,
                    static_cast<Buffer<int>&>(surface.vertices.patches), busy_, vt.table.rows(),
                    vt.table.counts(), vt.others, tv.table.rows(), tv.table.counts(), tv.others,
                    ee.table.rows(), ee.table.counts(), ee.others, planes.rows(), planes.counts(),
                    planes.needs(), truncation_.planes(), contacts_.rows(), contacts_.counts(),
                    contacts_.needs(), corner0_, corner1_, corner2_, corner3_, normals_, weights_,
                    measures_, truncation_.least(), account_.nearest(), model_.vertex_count(),
                    pairs_.surface().triangle_count(), pairs_.surface().edge_count(), range_,
                    truncation_.slack(), factor, kInstance))}};
    auto& launches = fill_.launches;
    if (model_.scene.contact->planes) {
        truncation_.add_start(launches, WEFT_CONTACT_START_SLACK * range_);
    }
    showing_ = launches.size();
    for (const int ahead : {0, 1}) launches.push_back(snapshot(*model_.positions, ahead));
    launches.push_back(launch(kernels::find_strays, surface.patches.segments, pairs_.patch_low(),
                              pairs_.patch_high(), static_cast<Buffer<int>&>(surface.bodies),
                              motion_.carried(), motion_.chunk_of(), motion_.fences(),
                              motion_.strays(), motion_.body_count(), motion_.chunk_count(),
                              kInstance));
    if (sticking_) sticking_->add_recall(launches, anchors_);
}

std::vector<const TaskBody*> ContactResponse::bodies() const {
    auto list = pairs_.bodies();
    list.push_back(&fill_);
    list.push_back(&energy_.body());
    return list;
}

std::vector<std::string> ContactResponse::kinds() const {
    auto names = ContactPairs::kinds();
    names.push_back(fill_.name);
    names.push_back(energy_.body().name);
    return names;
}

std::vector<RowTable*> ContactResponse::tables() {
    auto list = pairs_.tables();
    list.push_back(&truncation_.table());
    list.push_back(&contacts_);
    return list;
}

bool ContactResponse::revise(Executor& executor) {
    executor.fetch(motion_.strays());
    executor.fetch(motion_.unquiet());
    return motion_.revise();
}

void ContactResponse::add_begin(std::vector<Launch>& launches, Buffer<float4>& targets) {
    const auto most = static_cast<float>(model_.scene.guard.max_speed * model_.h);
    launches.push_back(launch(kernels::begin_contacts, model_.vertices(), *model_.positions,
                              *model_.previous, targets, goals_, anchors_, strides_,
                              motion_.body_of(), motion_.carried(), motion_.body_count(),
                              kMargin * range_, most, kInstance));
}

void ContactResponse::add_begin_accesses(Step::Adding& task, int first, int last) {
    for (Buffer<float4>* buffer : {&goals_, &anchors_, &strides_}) {
        task.updates(*buffer, first, last);
    }
}

void ContactResponse::add_detection(Step& step, const std::vector<Region>& regions) {
    const auto for_each = [&](auto add) {
        for (const Region& r : regions) (pairs_.*add)(step, Part{r.begin, r.end}, r.id);
    };
    for_each(&ContactPairs::add_boxes);
    for_each(&ContactPairs::add_near);
    for_each(&ContactPairs::add_pairs);
    for (const Region& region : regions) add_fill(step, region);
}

/// A vertex' triangles and edges are its strip's, or those of the one before it.
void ContactResponse::add_fill(Step& step, const Region& region) {
    const auto [first, last] = vertices(region.begin, region.end);
    const int all = model_.vertex_count();
    auto task = step.add(fill_, 0, region.strips(), region.id);
    task.reads(anchors_, 0, all).reads(goals_, 0, all).updates(*model_.positions, first, last);
    add_pair_accesses(task, region);
    for (RowTable* table : {&truncation_.table(), &contacts_}) {
        task.updates(table->counts(), first, last).updates(table->needs(), first, last);
    }
    for (Buffer<int>* gate : {&touching_, &meeting_, &filling_, &truncation_.apart()}) {
        task.updates(*gate, region.begin, region.end);
    }
    task.updates(truncation_.planes(), truncation_.table().entries());
    for (Buffer<int>* corner : {&corner0_, &corner1_, &corner2_, &corner3_}) {
        task.updates(*corner, contacts_.entries());
    }
    for (Buffer<float4>* column : {&normals_, &weights_, &measures_}) {
        task.updates(*column, contacts_.entries());
    }
    if (sticking_) sticking_->add_recall_accesses(task);
    task.updates(truncation_.least(), first, last)
        .updates(account_.nearest(), first, last)
        .updates(truncation_.cut(), first, last)
        .updates(snapshots_, first, last)
        .updates(snapshots_, all + first, all + last);
    const Segments& patches = pairs_.buffers().patches.segments;
    const std::pair own(patches.item(region.begin), patches.item(region.end));
    task.reads(pairs_.patch_low(), own.first, own.second)
        .reads(pairs_.patch_high(), own.first, own.second)
        .updates(motion_.strays(), own.first, own.second)
        .updates(busy_, own.first, own.second);
}

void ContactResponse::add_pair_accesses(Step::Adding& task, const Region& region) {
    const int from = std::max(region.begin - 1, 0);
    const Segments& patches = pairs_.buffers().patches.segments;
    task.reads(pairs_.near().table.counts(), patches.item(from), patches.item(region.end));
    task.reads(pairs_.near_strips(), from, std::min(region.end + 1, model_.strips.count()));
    const auto add = [&](ContactPairs::Table& pairs, const Segments& items) {
        task.reads(pairs.table.counts(), items.item(from), items.item(region.end))
            .reads(pairs.others, pairs.table.entries(), from, region.end);
    };
    add(pairs_.vt(), pairs_.buffers().vertices.items.segments);
    add(pairs_.tv(), pairs_.buffers().triangles.items.segments);
    add(pairs_.ee(), pairs_.buffers().edges.items.segments);
}

Launch ContactResponse::gather(Phase phase, Buffer<float4>& positions, VertexItems& items,
                               Buffer<float>& sums) {
    return gather_from(phase, positions, snapshots_, model_.vertex_count(), items, sums);
}

/// No second half, and no way from there.
Launch ContactResponse::gather_at(Phase phase, Buffer<float4>& shared, VertexItems& items,
                                  Buffer<float>& sums) {
    return gather_from(phase, shared, shared, 0, items, sums);
}

Launch ContactResponse::gather_from(Phase phase, Buffer<float4>& positions,
                                    Buffer<float4>& snapshots, int second_half, VertexItems& items,
                                    Buffer<float>& sums) {
    return only_where(rows().gate(phase),
                      launch(kernels::gather_contacts, items.segments(phase), positions, snapshots,
                             items.vertices(), contacts_.rows(), contacts_.counts(), corner0_,
                             corner1_, corner2_, corner3_, normals_, weights_, measures_, slips_,
                             sums, items.count(), second_half, kIteration, friction_, creep_));
}

void ContactResponse::add_gather_accesses(Step::Adding& task, int iteration, int first_strip,
                                          int end_strip) {
    const auto [first, last] = vertices(first_strip, end_strip);
    const int all = model_.vertex_count();
    const int half = iteration % 2 * all;
    task.reads(snapshots_, half, half + all);
    rows().add_reads(task, first_strip, end_strip, first, last);
}

Launch ContactResponse::snapshot(Buffer<float4>& positions, int ahead) {
    return only_where(
        touching_, launch(kernels::take_snapshot, model_.vertices(), positions, truncation_.least(),
                          snapshots_, model_.vertex_count(), kIteration, ahead));
}

void ContactResponse::add_truncation(std::vector<Launch>& launches, Buffer<float4>& positions,
                                     int all_from) {
    if (model_.scene.contact->planes) truncation_.add(launches, positions, all_from);
}

void ContactResponse::add_snapshot(std::vector<Launch>& launches, Buffer<float4>& positions) {
    launches.push_back(snapshot(positions, 1));
}

void ContactResponse::add_snapshot_accesses(Step::Adding& task, int iteration, int first_strip,
                                            int end_strip) {
    const auto [first, last] = vertices(first_strip, end_strip);
    const int half = (iteration + 1) % 2 * model_.vertex_count();
    task.reads(touching_, first_strip, end_strip)
        .reads(truncation_.least(), first, last)
        .updates(snapshots_, half + first, half + last);
}

void ContactResponse::add_start_snapshots(std::vector<Launch>& launches,
                                          Buffer<float4>& positions) {
    for (const int ahead : {0, 1}) launches.push_back(snapshot(positions, ahead));
}

void ContactResponse::add_start_snapshot_accesses(Step::Adding& task, StripRange strips) {
    for (const int iteration : {0, 1}) {
        add_snapshot_accesses(task, iteration, strips.begin, strips.end);
    }
}

/// Both halves: who hears late of others sees of them where they began, not an earlier substep.
void ContactResponse::show_start(Launch even, Launch odd) {
    fill_.launches[showing_] = std::move(even);
    fill_.launches[showing_ + 1] = std::move(odd);
}

void ContactResponse::add_count(std::vector<Launch>& launches) {
    account_.add_launch(launches, cut(), anchors_, goals_);
    launches.push_back(launch(kernels::find_unquiet, model_.vertices(), *model_.positions, anchors_,
                              goals_, quiet_, motion_.unquiet(), kInstance));
    if (insides_) insides_->add_launch(launches, cut());
}

void ContactResponse::add_count_accesses(Step::Adding& task, int first, int last) {
    task.reads(cut(), first, last)
        .reads(anchors_, first, last)
        .reads(goals_, first, last)
        .updates(motion_.unquiet(), first, last);
    account_.add_accesses(task, first, last);
    if (insides_) insides_->add_accesses(task, first, last);
}

ContactRows ContactResponse::rows() {
    return {contacts_, corner0_,  corner1_, corner2_,  corner3_, normals_,
            weights_,  measures_, slips_,   touching_, meeting_};
}

std::vector<BufferStorage*> ContactResponse::state() {
    if (!sticking_) return {};
    return {&sticking_->kept()};
}

Rubbing ContactResponse::rubbing() const {
    return {static_cast<double>(friction_), static_cast<double>(creep_)};
}

std::vector<FrozenContact> ContactResponse::frozen() {
    return frozen_contacts(rows(), model_.positions->span(), rubbing());
}

void ContactResponse::put(std::span<const FrozenContact> contacts,
                          std::span<const float4> positions, std::span<const float4> targets) {
    fill_rows(rows(), contacts, positions, targets);
    // Who has pairs is not known.
    std::ranges::fill(truncation_.least().span(), 0.0f);
    std::ranges::fill(touching_.span(), 1);
    std::ranges::fill(meeting_.span(), 1);
    std::ranges::fill(apart().span(), 0);
}

ContactRecord ContactResponse::record() {
    const auto sum = [](Buffer<int>& needs) {
        return std::accumulate(needs.span().begin(), needs.span().end(), std::uint64_t{0});
    };
    ContactRecord record = account_.record();
    record.pairs = sum(pairs_.vt().table.needs()) + sum(pairs_.ee().table.needs()) / 2;
    record.rows = sum(contacts_.needs());
    return record;
}

std::pair<int, int> ContactResponse::vertices(int first_strip, int end_strip) const {
    return {model_.vertices().item(first_strip), model_.vertices().item(end_strip)};
}

}  // namespace weft
