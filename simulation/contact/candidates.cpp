#include "simulation/contact/candidates.h"

#include "kernels/contact/nearing.h"

namespace weft {

namespace {

// In parts of the thickness.
constexpr float kMostSlack = 1.0f;      ///< more makes too many candidates
constexpr float kLeastSlack = 0.0625f;  ///< less would save few of them
constexpr float kSpare = 1.0f / 64.0f;  ///< far above what distances are rounded by
// In substeps; see kernels/contact/nearing.h.
constexpr float kSubsteps = 8.0f;
constexpr float kWorthwhile = 1.0f;

}  // namespace

PairCandidates::PairCandidates(SurfaceBuffers& s, Buffer<float4>& strides, float thickness,
                               int room)
    : s_(s),
      strides_(strides),
      least_(kLeastSlack * thickness),
      most_(kMostSlack * thickness),
      spare_(kSpare * thickness),
      low_("contact.strides.low", s.bodies.count()),
      high_("contact.strides.high", s.bodies.count()),
      kept_("contact.kept", s.patches.segments, 8 * room),
      spent_(kept_.table.add_column<float>("spent")),
      slacks_("contact.slacks", s.bodies.count()),
      stamps_("contact.stamps", s.bodies.count()),
      stale_("contact.stale", s.bodies.count()),
      epoch_("contact.epoch", 1),
      triangles_("contact.candidates.triangles", s.vertices.items.segments, 2 * room),
      vertices_("contact.candidates.vertices", s.triangles.items.segments, room),
      edges_("contact.candidates.edges", s.edges.items.segments, 2 * room) {
    epoch_[0] = 1;
}

std::vector<RowTable*> PairCandidates::tables() {
    return {&kept_.table, &triangles_.table, &vertices_.table, &edges_.table};
}

BufferStorage& PairCandidates::forget() {
    ++epoch_[0];
    return epoch_;
}

Launch PairCandidates::enclose() {
    return launch(kernels::enclose_strides, s_.patches.segments, strides_,
                  static_cast<Buffer<int>&>(s_.hulls.begin),
                  static_cast<Buffer<int>&>(s_.hulls.items), kept_.table.counts(), low_, high_);
}

void PairCandidates::add_enclose_accesses(Step::Adding& task, int first, int next, int first_patch,
                                          int last_patch) {
    task.reads(strides_, first, next)
        .reads(kept_.table.counts(), first_patch, last_patch)
        .updates(low_, first_patch, last_patch)
        .updates(high_, first_patch, last_patch);
}

Launch PairCandidates::check(PairTable& near, PatchBounds bounds) {
    RowTable& kept = kept_.table;
    return launch(
        kernels::check_candidates, s_.patches.segments, bounds.low, bounds.high, bounds.slant_low,
        bounds.slant_high, low_, high_, near.table.rows(), near.table.counts(), near.others,
        kept.rows(), kept.counts(), kept.needs(), kept_.others, spent_, slacks_, stamps_, stale_,
        epoch_, kept.age(), triangles_.table.age(), vertices_.table.age(), edges_.table.age(),
        kept.item_count(), margin(), spare_, least_, most_, kSubsteps, kWorthwhile, kInstance);
}

void PairCandidates::add_check_accesses(Step::Adding& task, int first_patch, int last_patch) {
    task.reads(low_, 0, kept_.table.item_count()).reads(high_, 0, kept_.table.item_count());
    kept_.add_fills(task, first_patch, last_patch);
    task.updates(spent_, kept_.table.entries())
        .updates(slacks_, first_patch, last_patch)
        .updates(stamps_, first_patch, last_patch)
        .updates(stale_, first_patch, last_patch);
}

}  // namespace weft
