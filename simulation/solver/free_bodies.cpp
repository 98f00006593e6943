#include "simulation/solver/free_bodies.h"

#include <algorithm>

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
        const bool solid = is_solid(model, begin, last);
        while (begin < last) {
            const int strip = model.strips.strip_of(begin);
            const int end = std::min(last, model.strips.begin[at(strip + 1)]);
            WEFT_ASSERT(begin < end);
            runs.push_back({body, strip, begin, end, solid});
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
      run_of_("free.run_of", at(model.vertex_count())) {
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
    std::vector<std::size_t> sizes;
    std::vector<int> vertices;
    std::vector<double> shares;
    for (const Run& run : runs_) {
        double mass = 0.0;
        for (int v = bodies[at(run.body)]; v < bodies[at(run.body + 1)]; ++v)
            mass += model.masses[at(v)];
        sizes.push_back(at(run.end - run.begin));
        for (int v = run.begin; v < run.end; ++v) {
            vertices.push_back(v);
            shares.push_back(model.masses[at(v)] / mass);
        }
    }
    const PartColumns columns = lay_in_columns(sizes);
    std::ranges::copy(columns.rows, rows_.data());
    members_ = std::make_unique<Buffer<int>>("free.members", columns.entries.size());
    shares_ = std::make_unique<Buffer<float>>("free.shares", columns.entries.size());
    fill_members(columns, vertices, shares, *members_, *shares_);
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
