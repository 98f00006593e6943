#include "simulation/solver/moment_sums.h"

#include <algorithm>

#include "kernels/bodies/moments.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_MOMENT_PARTS;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// The vertex in the middle of a body's order is somewhere in its middle.
MomentSums::MomentSums(FreeBodies& bodies, PushedSolids solids)
    : bodies_(bodies),
      origins_("free.origins", at(bodies.column_count())),
      firm_("free.firm", origins_.count()),
      partials_("free.partials", at(kParts * bodies.column_count())),
      sums_("free.moments", at(kParts * (bodies.run_count() + bodies.most_runs()))) {
    for (int first = 0, end = 0; first < bodies.run_count(); first = end) {
        while (end < bodies.run_count() && bodies.run(end).body == bodies.run(first).body) ++end;
        const int middle = (bodies.run(first).begin + bodies.run(end - 1).end) / 2;
        std::fill(origins_.data() + WEFT_RUN_COLUMNS * first,
                  origins_.data() + WEFT_RUN_COLUMNS * end, middle);
        std::fill(firm_.data() + WEFT_RUN_COLUMNS * first, firm_.data() + WEFT_RUN_COLUMNS * end,
                  bodies.run(first).is_solid && solids == PushedSolids::kTurned ? 1.0f : 0.0f);
    }
}

std::vector<Launch> MomentSums::sum(Model& model, Buffer<float4>& positions,
                                    Buffer<float4>& targets, const ObstaclePushes& pushes) {
    model_ = &model;
    pushes_ = pushes;
    const BodyColumns columns = bodies_.columns();
    const bool are_pushed = pushes.starts != nullptr;
    Buffer<float4>& starts = are_pushed ? *pushes.starts : targets;
    Buffer<float4>& pressing = pushes.pressing != nullptr ? *pushes.pressing : targets;
    return {launch(kernels::add_moments, columns.by_strip, positions, targets,
                   are_pushed ? *model.previous : targets, starts, pressing, columns.members,
                   columns.shares, columns.rows, origins_, firm_, partials_, are_pushed ? 1 : 0,
                   columns.count),
            bodies_.add_columns(partials_, sums_, {kParts, 1, kParts})};
}

void MomentSums::add_sum_accesses(Step::Adding& task, const Region& region) {
    const auto [first, end] = bodies_.runs_in(region.begin, region.end);
    task.updates(sums_, kParts * first, kParts * end);
    if (pushes_.starts == nullptr) return;
    const int first_vertex = model_->vertices().item(region.begin);
    const int end_vertex = model_->vertices().item(region.end);
    task.reads(*model_->previous, first_vertex, end_vertex)
        .reads(*pushes_.starts, first_vertex, end_vertex);
    if (pushes_.pressing) task.reads(*pushes_.pressing, first_vertex, end_vertex);
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
