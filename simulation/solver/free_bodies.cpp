#include "simulation/solver/free_bodies.h"

#include <algorithm>

#include "kernels/descent/free_bodies.h"
#include "scheduler/assert.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

constexpr int kColumns = WEFT_RUN_COLUMNS;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_held(const Model& model, int begin, int end) {
    const auto held = [](const float4& x) { return x.w <= 0.0f; };
    return std::any_of(model.positions->data() + begin, model.positions->data() + end, held);
}

}  // namespace

std::unique_ptr<FreeBodies> FreeBodies::of(const Model& model) {
    const std::vector<int> bodies = component_begins(model.vertex_count(), model.stencils());
    std::vector<Run> runs = runs_of(model, bodies);
    if (runs.empty()) return nullptr;
    return std::unique_ptr<FreeBodies>(new FreeBodies(model, bodies, std::move(runs)));
}

/// A vertex alone falls exactly by itself.
std::vector<FreeBodies::Run> FreeBodies::runs_of(const Model& model,
                                                 const std::vector<int>& bodies) {
    std::vector<Run> runs;
    for (int body = 0; body + 1 < static_cast<int>(bodies.size()); ++body) {
        const int last = bodies[at(body + 1)];
        int begin = bodies[at(body)];
        if (last - begin < 2 || is_held(model, begin, last)) continue;
        while (begin < last) {
            const int strip = model.strips.strip_of(begin);
            const int end = std::min(last, model.strips.begin[at(strip + 1)]);
            WEFT_ASSERT(begin < end);
            runs.push_back({body, strip, begin, end});
            begin = end;
        }
    }
    return runs;
}

FreeBodies::FreeBodies(const Model& model, const std::vector<int>& bodies, std::vector<Run> runs)
    : runs_(std::move(runs)),
      strip_runs_("free.strip_runs", model.strips.begin.size()),
      strip_columns_("free.strip_columns", model.strips.begin.size()),
      rows_("free.rows", 2 * kColumns * runs_.size()),
      first_run_("free.first_run", runs_.size()),
      counts_("free.counts", runs_.size()),
      run_of_("free.run_of", at(model.vertex_count())),
      partials_("free.partials", kColumns * runs_.size()),
      lags_("free.lags", 2 * runs_.size()),
      shifts_("free.shifts", runs_.size() + 1),
      vertices_(model.vertices()) {
    fill_strips(model);
    fill_bodies();
    fill_columns(model, bodies);
    WEFT_ASSERT(strip_runs_[at(model.strips.count())] == static_cast<int>(runs_.size()));
    runs_by_strip_ = {&strip_runs_, 0, 1, model.strips.count()};
    columns_by_strip_ = {&strip_columns_, 0, 1, model.strips.count()};
}

void FreeBodies::fill_strips(const Model& model) {
    std::fill(run_of_.data(), run_of_.data() + run_of_.count(), static_cast<int>(runs_.size()));
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        ++strip_runs_[at(runs_[r].strip + 1)];
        std::fill(run_of_.data() + runs_[r].begin, run_of_.data() + runs_[r].end,
                  static_cast<int>(r));
    }
    for (int s = 0; s < model.strips.count(); ++s) {
        strip_runs_[at(s + 1)] += strip_runs_[at(s)];
        strip_columns_[at(s + 1)] = kColumns * strip_runs_[at(s + 1)];
    }
}

/// The runs of one body follow each other.
void FreeBodies::fill_bodies() {
    for (std::size_t first = 0; first < runs_.size();) {
        std::size_t end = first;
        while (end < runs_.size() && runs_[end].body == runs_[first].body) ++end;
        std::fill(first_run_.data() + first, first_run_.data() + end, static_cast<int>(first));
        std::fill(counts_.data() + first, counts_.data() + end, static_cast<float>(end - first));
        most_runs_ = std::max(most_runs_, static_cast<int>(end - first));
        ++body_count_;
        first = end;
    }
}

void FreeBodies::fill_columns(const Model& model, const std::vector<int>& bodies) {
    std::vector<int> members;
    std::vector<float> shares;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
        const Run& run = runs_[r];
        double mass = 0.0;
        for (int v = bodies[at(run.body)]; v < bodies[at(run.body + 1)]; ++v)
            mass += model.masses[at(v)];
        const int rows = (run.end - run.begin + kColumns - 1) / kColumns;
        for (int c = 0; c < kColumns; ++c) {
            rows_[2 * (kColumns * r + at(c))] = static_cast<int>(members.size()) + c;
            rows_[2 * (kColumns * r + at(c)) + 1] = rows;
        }
        for (int v = run.begin; v < run.begin + rows * kColumns; ++v) {
            const bool is_member = v < run.end;
            members.push_back(is_member ? v : run.begin);
            shares.push_back(is_member ? static_cast<float>(model.masses[at(v)] / mass) : 0.0f);
        }
    }
    members_ = std::make_unique<Buffer<int>>("free.members", members.size());
    shares_ = std::make_unique<Buffer<float>>("free.shares", shares.size());
    std::ranges::copy(members, members_->data());
    std::ranges::copy(shares, shares_->data());
}

bool FreeBodies::reach_into(int first_strip, int end_strip) const {
    return strip_runs_[at(first_strip)] < strip_runs_[at(end_strip)];
}

int FreeBodies::column_count() const { return kColumns * run_count(); }

std::pair<int, int> FreeBodies::runs_in(int first_strip, int end_strip) const {
    return {strip_runs_[at(first_strip)], strip_runs_[at(end_strip)]};
}

BodyColumns FreeBodies::columns() {
    return {*members_, *shares_, rows_, columns_by_strip_, column_count()};
}

std::vector<Launch> FreeBodies::sum(Buffer<float4>& positions, Buffer<float4>& targets) {
    return {launch(kernels::add_lags, columns_by_strip_, positions, targets, *members_, *shares_,
                   rows_, partials_),
            add_columns(partials_, lags_, 1, 0)};
}

FreeBodies::Sums::Sums(const FreeBodies& bodies, int part_count, int count_of_lags)
    : parts(part_count),
      lag_count(count_of_lags),
      begin("free.sums", bodies.strip_runs_.count()),
      starts("free.starts", at(parts) * bodies.runs_.size()),
      places("free.places", starts.count()) {
    std::ranges::transform(bodies.strip_runs_.span(), begin.data(),
                           [&](int run) { return parts * run; });
    for (int run = 0; run < bodies.run_count(); ++run) {
        for (int part = 0; part < parts; ++part) {
            starts[at(parts * run + part)] = part * bodies.column_count() + kColumns * run;
            places[at(parts * run + part)] = part * lag_count + run;
        }
    }
}

FreeBodies::Sums& FreeBodies::sums(int parts, int lag_count) {
    for (const auto& known : sums_) {
        if (known->parts == parts && known->lag_count == lag_count) return *known;
    }
    return *sums_.emplace_back(std::make_unique<Sums>(*this, parts, lag_count));
}

Launch FreeBodies::add_columns(Buffer<float4>& partials, Buffer<float4>& lags, int parts,
                               int lag_count) {
    Sums& items = sums(parts, lag_count);
    const Segments segments{&items.begin, 0, 1, runs_by_strip_.strip_count};
    return launch(kernels::add_columns, segments, partials, items.starts, items.places, lags);
}

void FreeBodies::add_sum_accesses(Step::Adding& task, int first_strip, int end_strip) {
    const auto [first, last] = runs_in(first_strip, end_strip);
    task.updates(lags_, first, last);
}

std::vector<Launch> FreeBodies::shift(Model& model, Buffer<float4>& deviations) {
    return {
        launch(kernels::add_runs, runs_by_strip_, lags_, first_run_, counts_, shifts_, most_runs_),
        launch(kernels::shift_bodies, vertices_, *model.positions, deviations, *model.velocities,
               shifts_, run_of_, static_cast<float>(1.0 / model.h))};
}

void FreeBodies::add_shift_accesses(Step::Adding& task) { task.reads(lags_, 0, run_count()); }

}  // namespace weft
