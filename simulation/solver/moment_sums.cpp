#include "simulation/solver/moment_sums.h"

#include <algorithm>

#include "kernels/bodies/moments.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_MOMENT_PARTS;
constexpr int kStillParts = WEFT_STILL_PARTS;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

MomentSums::MomentSums(FreeBodies& bodies, bool may_be_pushed)
    : bodies_(bodies),
      origins_("free.origins", at(bodies.column_count())),
      partials_("free.partials",
                at((may_be_pushed ? kParts : kStillParts) * bodies.column_count())),
      sums_("free.moments", at(kParts * (bodies.run_count() + bodies.most_runs()))) {
    for (int r = 0; r < bodies.run_count(); ++r) {
        std::fill_n(origins_.data() + WEFT_RUN_COLUMNS * r, WEFT_RUN_COLUMNS, bodies.run(r).origin);
    }
}

std::vector<Launch> MomentSums::sum(Model& model, Buffer<float4>& positions,
                                    Buffer<float4>& targets, Buffer<float4>* starts) {
    model_ = &model;
    const BodyColumns columns = bodies_.columns();
    return {
        launch(kernels::add_moments, columns.by_strip, positions, targets,
               starts ? *model.previous : targets, starts ? *starts : targets, columns.members,
               columns.shares, columns.rows, origins_, partials_, starts ? 1 : 0, columns.count),
        bodies_.add_columns(partials_, sums_, {starts ? kParts : kStillParts, 1, kParts})};
}

void MomentSums::add_sum_accesses(Step::Adding& task, const Region& region,
                                  Buffer<float4>* starts) {
    const auto [first, end] = bodies_.runs_in(region.begin, region.end);
    task.updates(sums_, kParts * first, kParts * end);
    if (starts == nullptr) return;
    const int first_vertex = model_->vertices().item(region.begin);
    const int end_vertex = model_->vertices().item(region.end);
    task.reads(*model_->previous, first_vertex, end_vertex)
        .reads(*starts, first_vertex, end_vertex);
}

void MomentSums::add_origin_reads(Step::Adding& task, const Region& region,
                                  Buffer<float4>& positions) {
    const auto [first, end] = bodies_.runs_in(region.begin, region.end);
    int known = -1;
    for (int r = first; r < end; ++r) {
        const int origin = origins_[at(WEFT_RUN_COLUMNS * r)];
        const bool is_own = bodies_.run(first).begin <= origin && origin < bodies_.run(end - 1).end;
        if (!is_own && origin != known) task.reads(positions, origin, origin + 1);
        known = origin;
    }
}

void MomentSums::add_reads(Step::Adding& task) {
    task.reads(sums_, 0, kParts * bodies_.run_count());
}

}  // namespace weft
