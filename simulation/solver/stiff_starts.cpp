#include "simulation/solver/stiff_starts.h"

#include <algorithm>

#include "kernels/bodies/starts.h"
#include "simulation/model/rest_stiffness.h"

namespace weft {

namespace {

/// How many times as hard as inertia elements hold the vertices of bodies, their mean, for which
/// the shape that they had may be the better start; from where on it needs no margin; and up to
/// where, for cloth that is held on several sides: such cloth sags by bending, of which that shape
/// knows nothing, and beyond stands still. Newton takes back what x~ strains until numbers are too
/// short for that, and bends what it starts from.
struct Stiff {
    double least, without_margin, most_on_several_sides;
};
constexpr Stiff kStiff{100.0, 1000.0, 1e7};
constexpr Stiff kStiffForAll{2e5, 2e5, 1e30};

/// Of the energy of motion.
constexpr float kMargin = 0.1f;
constexpr float kNever = -1.0f;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// [vertices] The number of the body of each; -1: of none of these.
std::vector<int> number_vertices(const Model& model, const std::vector<HeldBody>& bodies) {
    std::vector<int> body_of(model.positions->count(), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        std::fill(body_of.begin() + bodies[b].whole.begin, body_of.begin() + bodies[b].whole.end,
                  static_cast<int>(b));
    }
    return body_of;
}

/// Adds how hard a family holds what is free of each body [N/m]: every 16th element of one speaks
/// for the next ones, too.
void add_stiffness(const Model& model, const ElementFamily& family, const std::vector<int>& body_of,
                   std::vector<double>& stiffness) {
    constexpr int kSpeaksFor = 16;
    struct Sum {
        double stiffness = 0.0;
        int elements = 0, counted = 0;
    };
    std::vector<Sum> sums(stiffness.size());
    for (int e = 0; e < family.count(); ++e) {
        const auto corners = family.corners(e);
        const int body = body_of[at(corners[0])];
        if (body < 0) continue;
        Sum& sum = sums[at(body)];
        if (sum.elements++ % kSpeaksFor != 0) continue;
        ++sum.counted;
        const auto held = rest_stiffness(family, e, model.positions->span());
        for (std::size_t k = 0; k < corners.size(); ++k) {
            if (!is_held(model, corners[k])) sum.stiffness += held[k];
        }
    }
    for (std::size_t b = 0; b < sums.size(); ++b) {
        if (sums[b].counted > 0)
            stiffness[b] += sums[b].stiffness * sums[b].elements / sums[b].counted;
    }
}

/// How many times as hard as inertia elements hold the vertices of each body.
std::vector<double> firmness_of(const Model& model, const std::vector<HeldBody>& bodies) {
    const std::vector<int> body_of = number_vertices(model, bodies);
    std::vector<double> firmness(bodies.size());
    for (const auto& family : model.families) add_stiffness(model, *family, body_of, firmness);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        double mass = 0.0;
        for (int v = bodies[b].whole.begin; v < bodies[b].whole.end; ++v) {
            if (!is_held(model, v)) mass += model.masses[at(v)];
        }
        firmness[b] *= model.h * model.h / mass;
    }
    return firmness;
}

float margin_of(const HeldBody& body, double firmness, const Stiff& stiff) {
    const bool is_beyond = !body.goes_as_a_whole && firmness > stiff.most_on_several_sides;
    if (firmness < stiff.least || is_beyond) return kNever;
    return firmness > stiff.without_margin ? 0.0f : kMargin;
}

}  // namespace

std::unique_ptr<StiffStarts> StiffStarts::of(Model& model, HeldBodies* held, const Setting& setting,
                                             int first_kind) {
    const bool may_be_touched = model.obstacles || setting.contact;
    const std::vector<HeldBody> bodies =
        may_be_touched ? held_bodies(model) : movable_bodies(model);
    const std::vector<double> firmness = firmness_of(model, bodies);
    const Stiff& stiff = setting.solves_all ? kStiffForAll : kStiff;
    std::vector<float> margins;
    bool needs_others = false;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        margins.push_back(margin_of(bodies[b], firmness[b], stiff));
        const bool is_moved_at_end = bodies[b].goes_as_a_whole && !bodies[b].vertices.empty();
        needs_others = needs_others || (margins[b] >= 0.0f && !is_moved_at_end);
    }
    if (std::ranges::all_of(margins, [](float margin) { return margin < 0.0f; })) return nullptr;
    return std::unique_ptr<StiffStarts>(
        new StiffStarts(model, held, needs_others, bodies, margins, setting, first_kind));
}

StiffStarts::StiffStarts(Model& model, HeldBodies* held, bool needs_others,
                         const std::vector<HeldBody>& bodies, const std::vector<float>& margins,
                         const Setting& setting, int first_kind)
    : model_(model),
      own_sums_(needs_others ? std::make_unique<HeldSums>(model, bodies) : nullptr),
      held_sums_(own_sums_ ? *own_sums_ : held->sums()),
      setting_(setting),
      margins_("starts.margins", at(held_sums_.bodies().run_count())),
      touched_(held ? held->touched() : nullptr),
      bounds_("starts.bounds", 2 * margins_.count()),
      carries_("starts.carries", margins_.count() + 1),
      rises_("starts.rises", model.positions->count()),
      totals_("starts.totals",
              at(held_sums_.bodies().run_count() + held_sums_.bodies().most_runs())),
      chosen_("starts.chosen", margins_.count()) {
    const std::vector<int> body_of = number_vertices(model, bodies);
    for (int r = 0; r < held_sums_.bodies().run_count(); ++r) {
        const FreeBodies::Run& run = held_sums_.bodies().run(r);
        margins_[at(r)] = margins[at(body_of[at(run.begin)])];
        bounds_[at(r)] = run.begin;
        bounds_[margins_.count() + at(r)] = run.end;
    }
    make_bodies(first_kind);
}

std::vector<std::string> StiffStarts::kinds() {
    return {"start_sums", "start_motions", "start_rises", "start_totals", "starts"};
}

/// From where bodies were, pins included; what these have been led by since counts as a pull.
HeldSums::Place StiffStarts::place() {
    return {*model_.previous, setting_.targets, nullptr, model_.positions.get()};
}

void StiffStarts::make_bodies(int first_kind) {
    const auto body = [&](Kind kind, std::vector<Launch> launches) {
        return TaskBody{kinds()[at(kind)], first_kind + kind, std::move(launches)};
    };
    FreeBodies& bodies = held_sums_.bodies();
    const BodyRuns runs = bodies.runs();
    const BodyColumns columns = bodies.columns();
    sums_ = body(kSums, held_sums_.sum(place()));
    sums_.launches.push_back(launch(kernels::find_carries, runs.by_strip, *model_.previous,
                                    *model_.positions, held_sums_.ends(), carries_));
    motions_ =
        body(kMotions, {launch(kernels::solve_starts, runs.by_strip, held_sums_.moments().sums(),
                               held_sums_.pulls(), runs.first, runs.counts, held_sums_.hinges(),
                               carries_, held_sums_.numbers(), margins_, held_sums_.motions(),
                               bodies.most_runs(), bodies.run_count())});
    Buffer<float4>& partials = held_sums_.moments().partials();
    totals_body_ = body(kTotals, {launch(kernels::add_rises, columns.by_strip, rises_,
                                         columns.members, columns.shares, columns.rows, partials),
                                  bodies.add_columns(partials, totals_, {1, 1, 1})});
    starts_ = body(
        kStarts,
        {launch(kernels::choose_starts, runs.by_strip, totals_, runs.first, runs.counts, margins_,
                touched_ ? *touched_ : margins_, chosen_, bodies.most_runs(), touched_ ? 1 : 0),
         launch(kernels::start_moved, columns.by_strip, *model_.positions, *model_.previous,
                held_sums_.motions(), chosen_, columns.members, columns.shares, columns.rows,
                held_sums_.runs(), bodies.run_count())});
    seam_rises_ = body(kRises, {});
    strip_rises_ = body(kRises, {});
    for (const Phase phase : setting_.phases)
        (phase == kSeamPhase ? seam_rises_ : strip_rises_).launches = weigh(phase);
}

std::vector<Launch> StiffStarts::weigh(Phase phase) {
    std::vector<Launch> launches = setting_.derivatives.gather_gradients(phase, *model_.positions);
    launches.push_back(launch(
        kernels::weigh_starts, setting_.items.segments(phase), *model_.positions, *model_.previous,
        setting_.targets, held_sums_.motions(), carries_, bounds_, setting_.items.vertices(),
        setting_.derivatives.sums(), rises_, setting_.items.count(),
        static_cast<float>(1.0 / (model_.h * model_.h)), held_sums_.bodies().run_count()));
    return launches;
}

std::vector<const TaskBody*> StiffStarts::bodies() const {
    std::vector<const TaskBody*> list{&sums_, &motions_};
    for (const TaskBody* body : {&seam_rises_, &strip_rises_}) {
        if (!body->launches.empty()) list.push_back(body);
    }
    list.insert(list.end(), {&totals_body_, &starts_});
    return list;
}

void StiffStarts::add(Step& step, const std::vector<Region>& regions) {
    using Add = void (StiffStarts::*)(Step&, const Region&);
    for (const Add part : {&StiffStarts::add_sums, &StiffStarts::add_motions,
                           &StiffStarts::add_rises, &StiffStarts::add_totals}) {
        for (const Region& region : regions) {
            if (held_sums_.bodies().reach_into(region.begin, region.end))
                (this->*part)(step, region);
        }
    }
    // Regions without such bodies, too: their iterations do not begin before others have seen where
    // they start.
    for (const Region& region : regions) add_starts(step, region);
}

void StiffStarts::add_sums(Step& step, const Region& region) {
    const auto [run, end_run] = held_sums_.bodies().runs_in(region.begin, region.end);
    auto task = step.add(sums_, 0, region.strips(), region.id);
    held_sums_.add_sum_accesses(task, region, place());
    task.reads(setting_.targets, model_.vertices().item(region.begin),
               model_.vertices().item(region.end))
        .updates(carries_, run, end_run);
}

void StiffStarts::add_motions(Step& step, const Region& region) {
    const auto [run, end_run] = held_sums_.bodies().runs_in(region.begin, region.end);
    auto task = step.add(motions_, 0, region.strips(), region.id);
    held_sums_.add_reads(task);
    held_sums_.add_motion_accesses(task, region.strips());
    task.reads(carries_, run, end_run);
}

/// As in sweeps.cpp.
void StiffStarts::add_rises(Step& step, const Region& region) {
    const auto& strips = model_.strips;
    for_each_part(
        region,
        [&](StripRange seams) {
            if (seam_rises_.launches.empty()) return;
            add_rises(step, seam_rises_, seams, region.id, strips.seam_begin[at(seams.begin)],
                      strips.seam_end[at(seams.end - 1)]);
        },
        [&](StripRange own) {
            add_rises(step, strip_rises_, own, region.id, model_.vertices().item(own.begin),
                      model_.vertices().item(own.end));
        });
}

void StiffStarts::add_rises(Step& step, const TaskBody& body, StripRange strips, RegionId region,
                            int first, int last) {
    const auto [halo_begin, halo_end] = setting_.halo.around(first, last);
    auto task = step.add(body, 0, strips, region);
    task.reads(*model_.positions, halo_begin, halo_end)
        .reads(*model_.previous, first, last)
        .reads(setting_.targets, first, last)
        .reads(carries_, 0, held_sums_.bodies().run_count())
        .updates(rises_, first, last);
    held_sums_.add_motion_reads(task);
    if (setting_.keeps_blocks)
        setting_.derivatives.add_hessian_accesses(task, first, last, /*writes=*/false);
}

void StiffStarts::add_totals(Step& step, const Region& region) {
    const auto [run, end_run] = held_sums_.bodies().runs_in(region.begin, region.end);
    step.add(totals_body_, 0, region.strips(), region.id)
        .reads(rises_, model_.vertices().item(region.begin), model_.vertices().item(region.end))
        .updates(totals_, run, end_run);
}

void StiffStarts::add_starts(Step& step, const Region& region) {
    const auto [run, end_run] = held_sums_.bodies().runs_in(region.begin, region.end);
    const int first = model_.vertices().item(region.begin);
    const int last = model_.vertices().item(region.end);
    auto task = step.add(starts_, 0, region.strips(), region.id);
    task.reads(totals_, 0, held_sums_.bodies().run_count())
        .reads(*model_.previous, first, last)
        .updates(*model_.positions, first, last);
    if (touched_ && run < end_run) task.reads(*touched_, run, end_run);
    held_sums_.add_motion_reads(task);
}

}  // namespace weft
