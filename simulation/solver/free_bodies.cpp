#include "simulation/solver/free_bodies.h"

#include <algorithm>
#include <numeric>

#include "kernels/bodies/runs.h"
#include "scheduler/assert.h"
#include "simulation/solver/part_columns.h"
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

/// Neighbours mostly are of the same body of the scene.
bool is_solid(const Model& model, int begin, int end) {
    const BodyRange* known = nullptr;
    for (int v = begin; v < end; ++v) {
        const SceneVertex vertex = model.scene_vertex(v);
        if (known && known->has(vertex)) continue;
        const auto has = [&](const BodyRange& body) { return body.has(vertex); };
        known = &*std::ranges::find_if(model.bodies, has);
        if (known->kind != "solid") return false;
    }
    return true;
}

namespace {

std::vector<FreeBodies::Run> runs_of(const Model& model,
                                     const std::vector<FreeBodies::Whole>& wholes) {
    std::vector<FreeBodies::Run> runs;
    for (int body = 0; body < static_cast<int>(wholes.size()); ++body) {
        const auto [first, last, origin] = wholes[at(body)];
        const bool solid = is_solid(model, first, last);
        for (int begin = first; begin < last;) {
            const int strip = model.strips.strip_of(begin);
            const int end = std::min(last, model.strips.begin[at(strip + 1)]);
            WEFT_ASSERT(begin < end);
            runs.push_back({body, strip, begin, end, origin, solid});
            begin = end;
        }
    }
    return runs;
}

/// Of each body, of what is free of it.
FreeBodies::Counted shares_of_mass(const Model& model,
                                   const std::vector<FreeBodies::Whole>& wholes) {
    const std::size_t count = model.positions->count();
    FreeBodies::Counted counted{std::vector<int>(count), std::vector<double>(count)};
    std::iota(counted.numbers.begin(), counted.numbers.end(), 0);
    for (const auto& whole : wholes) {
        double mass = 0.0;
        for (int v = whole.begin; v < whole.end; ++v) {
            counted.shares[at(v)] = is_held(model, v, v + 1) ? 0.0 : model.masses[at(v)];
            mass += counted.shares[at(v)];
        }
        for (int v = whole.begin; v < whole.end; ++v) counted.shares[at(v)] /= mass;
    }
    return counted;
}

}  // namespace

/// A vertex alone falls exactly by itself. The vertex in the middle of a body's order is somewhere
/// in its middle.
std::unique_ptr<FreeBodies> FreeBodies::of(const Model& model) {
    const std::vector<int> bodies = component_begins(model.vertex_count(), model.stencils());
    std::vector<Whole> wholes;
    for (std::size_t body = 0; body + 1 < bodies.size(); ++body) {
        const int begin = bodies[body];
        const int end = bodies[body + 1];
        if (end - begin < 2 || is_held(model, begin, end)) continue;
        wholes.push_back({begin, end, (begin + end) / 2});
    }
    if (wholes.empty()) return nullptr;
    auto free = std::make_unique<FreeBodies>(model, wholes);
    free->number_vertices(model);
    return free;
}

FreeBodies::FreeBodies(const Model& model, const std::vector<Whole>& wholes)
    : FreeBodies(model, wholes, shares_of_mass(model, wholes)) {}

FreeBodies::FreeBodies(const Model& model, const std::vector<Whole>& wholes, const Counted& counted)
    : runs_(runs_of(model, wholes)),
      strip_runs_("free.strip_runs", model.strips.begin.size()),
      strip_columns_("free.strip_columns", model.strips.begin.size()),
      rows_("free.rows", 2 * kColumns * runs_.size()),
      first_run_("free.first_run", runs_.size()),
      counts_("free.counts", runs_.size()) {
    fill_strips(model);
    fill_bodies();
    fill_columns(counted);
    WEFT_ASSERT(strip_runs_[at(model.strips.count())] == static_cast<int>(runs_.size()));
    runs_by_strip_ = {&strip_runs_, 0, 1, model.strips.count()};
    columns_by_strip_ = {&strip_columns_, 0, 1, model.strips.count()};
}

void FreeBodies::fill_strips(const Model& model) {
    for (const Run& run : runs_) ++strip_runs_[at(run.strip + 1)];
    for (int s = 0; s < model.strips.count(); ++s) {
        strip_runs_[at(s + 1)] += strip_runs_[at(s)];
        strip_columns_[at(s + 1)] = kColumns * strip_runs_[at(s + 1)];
    }
}

void FreeBodies::number_vertices(const Model& model) {
    run_of_ = std::make_unique<Buffer<int>>("free.run_of", at(model.vertex_count()));
    std::fill_n(run_of_->data(), run_of_->count(), run_count());
    for (int r = 0; r < run_count(); ++r) {
        std::fill(run_of_->data() + run(r).begin, run_of_->data() + run(r).end, r);
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

void FreeBodies::fill_columns(const Counted& counted) {
    std::vector<std::size_t> sizes;
    std::vector<int> numbers;
    std::vector<double> shares;
    for (const Run& run : runs_) {
        const std::size_t before = numbers.size();
        for (int v = run.begin; v < run.end; ++v) {
            if (counted.numbers[at(v)] < 0) continue;
            numbers.push_back(counted.numbers[at(v)]);
            shares.push_back(counted.shares[at(v)]);
        }
        sizes.push_back(numbers.size() - before);
    }
    const PartColumns columns = lay_in_columns(sizes);
    std::ranges::copy(columns.rows, rows_.data());
    members_ = std::make_unique<Buffer<int>>("free.members", columns.entries.size());
    shares_ = std::make_unique<Buffer<float>>("free.shares", columns.entries.size());
    fill_members(columns, numbers, shares, *members_, *shares_);
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

FreeBodies::Sums::Sums(const FreeBodies& bodies, const SumLayout& kind)
    : layout(kind),
      begin("free.sums", bodies.strip_runs_.count()),
      starts("free.starts", at(layout.parts) * bodies.runs_.size()),
      places("free.places", starts.count()) {
    std::ranges::transform(bodies.strip_runs_.span(), begin.data(),
                           [&](int run) { return layout.parts * run; });
    for (int run = 0; run < bodies.run_count(); ++run) {
        for (int part = 0; part < layout.parts; ++part) {
            const std::size_t item = at(layout.parts * run + part);
            starts[item] = part * bodies.column_count() + kColumns * run;
            places[item] = part * layout.part_stride + run * layout.run_stride;
        }
    }
}

FreeBodies::Sums& FreeBodies::sums(const SumLayout& layout) {
    for (const auto& known : sums_) {
        if (known->layout == layout) return *known;
    }
    return *sums_.emplace_back(std::make_unique<Sums>(*this, layout));
}

Launch FreeBodies::add_columns(Buffer<float4>& partials, Buffer<float4>& sums,
                               const SumLayout& layout) {
    Sums& items = this->sums(layout);
    const Segments segments{&items.begin, 0, 1, runs_by_strip_.strip_count};
    return launch(kernels::add_columns, segments, partials, items.starts, items.places, sums);
}

}  // namespace weft
