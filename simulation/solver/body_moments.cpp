#include "simulation/solver/body_moments.h"

#include <algorithm>

#include "kernels/contact/moments.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_MOMENT_PARTS;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// The vertex in the middle of a body's order is somewhere in its middle.
BodyMoments::BodyMoments(FreeBodies& bodies, Buffer<int>& first_run, Buffer<float>& counts)
    : bodies_(bodies),
      first_run_(first_run),
      counts_(counts),
      sum_count_(bodies.run_count() + bodies.most_runs()),
      origins_("touching.origins", at(bodies.column_count())),
      partials_("touching.moments.partials", at(kParts * bodies.column_count())),
      sums_("touching.moments.sums", at(kParts * sum_count_)),
      moments_("touching.moments", at(kParts * (bodies.body_count() + 1))) {
    for (int first = 0, end = 0; first < bodies.run_count(); first = end) {
        while (end < bodies.run_count() && bodies.run(end).body == bodies.run(first).body) ++end;
        const int middle = (bodies.run(first).begin + bodies.run(end - 1).end) / 2;
        std::fill(origins_.data() + WEFT_RUN_COLUMNS * first,
                  origins_.data() + WEFT_RUN_COLUMNS * end, middle);
    }
}

std::vector<Launch> BodyMoments::sum(Buffer<float4>& positions, Buffer<float4>& targets) {
    const BodyColumns columns = bodies_.columns();
    return {launch(kernels::add_moments, columns.by_strip, positions, targets, columns.members,
                   columns.shares, columns.rows, origins_, partials_, columns.count),
            bodies_.add_columns(partials_, sums_, kParts, sum_count_)};
}

void BodyMoments::add_sum_accesses(Step::Adding& task, const Region& region) {
    const auto [first, last] = bodies_.runs_in(region.begin, region.end);
    for (int part = 0; part < kParts; ++part) {
        task.updates(sums_, part * sum_count_ + first, part * sum_count_ + last);
    }
}

Launch BodyMoments::weigh(const Segments& all) {
    return launch(kernels::weigh_bodies, all, sums_, first_run_, counts_, moments_,
                  bodies_.most_runs(), sum_count_, bodies_.body_count());
}

void BodyMoments::add_weigh_accesses(Step::Adding& task) {
    for (int part = 0; part < kParts; ++part) {
        task.reads(sums_, part * sum_count_, part * sum_count_ + bodies_.run_count());
    }
    task.updates(moments_, 0, static_cast<int>(moments_.count()));
}

void BodyMoments::add_reads(Step::Adding& task) {
    task.reads(moments_, 0, static_cast<int>(moments_.count()));
}

}  // namespace weft
