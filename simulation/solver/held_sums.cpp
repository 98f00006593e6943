#include "simulation/solver/held_sums.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "kernels/bodies/held_bodies.h"
#include "simulation/families/convert.h"
#include "simulation/solver/accesses.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_PULL_PARTS;
static_assert(kParts <= WEFT_STILL_PARTS, "they share their scratch");

/// Of the shortest way between what is held and what is free: bodies that would go further against
/// what holds them are not moved.
constexpr double kMostWay = 0.25;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<int> held_vertices(const std::vector<HeldBody>& bodies) {
    std::vector<int> held;
    for (const auto& body : bodies)
        held.insert(held.end(), body.vertices.begin(), body.vertices.end());
    return held;
}

/// Of each held vertex, how many corners an element of it has at most that are held.
std::vector<int> most_held_corners(const Model& model) {
    std::vector<int> most(at(model.vertex_count()));
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto corners = kind[e];
            const auto held = static_cast<int>(
                std::ranges::count_if(corners, [&](int v) { return is_held(model, v); }));
            if (held == std::ssize(corners)) continue;
            for (const int v : corners) most[at(v)] = std::max(most[at(v)], held);
        }
    }
    return most;
}

/// Of each body, between a held and a free corner of an element [m]. 0 where a tie has no length:
/// it has no Hessian either, and says nothing of how it holds.
std::vector<double> shortest_at_held(const Model& model, const std::vector<HeldBody>& bodies) {
    std::vector<double> shortest(bodies.size(), std::numeric_limits<double>::max());
    std::vector<int> body_of(at(model.vertex_count()), -1);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        std::fill(body_of.begin() + bodies[b].whole.begin, body_of.begin() + bodies[b].whole.end,
                  static_cast<int>(b));
    }
    const auto place = [&](int v) { return to_vec3((*model.positions)[at(v)]); };
    for (const Stencils& kind : model.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            for (const int held : kind[e]) {
                if (!is_held(model, held)) continue;
                for (const int v : kind[e]) {
                    const int body = body_of[at(v)];
                    // Ties may lead to what is none of them.
                    if (is_held(model, v) || body < 0) continue;
                    double& least = shortest[at(body)];
                    least = std::min(least, length(place(v) - place(held)));
                }
            }
        }
    }
    return shortest;
}

FreeBodies::Counted counted_holds(const Model& model, const VertexItems& items) {
    FreeBodies::Counted counted{std::vector<int>(at(model.vertex_count()), -1),
                                std::vector<double>(at(model.vertex_count()))};
    const std::vector<int> most = most_held_corners(model);
    for (int item = 0; item < items.count(); ++item) {
        const int v = items.vertex(item);
        counted.numbers[at(v)] = item;
        // Also of those that have no free neighbour: their elements' forces add up to nothing, but
        // not one without the other.
        counted.shares[at(v)] = std::max(most[at(v)], 1);
    }
    return counted;
}

}  // namespace

HeldSums::HeldSums(Model& model, const std::vector<HeldBody>& bodies)
    : model_(model),
      bodies_(model, wholes_of(bodies)),
      moments_(bodies_, model.obstacles != nullptr),
      items_(model.strips, held_vertices(bodies)),
      derivatives_(model, items_),
      holds_(model, wholes_of(bodies), counted_holds(model, items_)),
      runs_("held.runs", at(bodies_.column_count())),
      ends_("held.ends", 2 * at(bodies_.run_count())),
      numbers_("held.numbers", 3 * at(bodies_.run_count())),
      pulls_("held.pulls", at(kParts * (holds_.run_count() + holds_.most_runs()))),
      hinges_("held.hinges", ends_.count()),
      motions_("held.motions", 3 * at(bodies_.run_count() + 1)) {
    find_seen();
    fill_runs(bodies);
}

void HeldSums::find_seen() {
    const auto& begin = model_.strips.begin;
    for (int s = 0; s < model_.strips.count(); ++s)
        seen_by_.push_back({begin[at(s)], begin[at(s + 1)]});
    for (const Stencils& kind : model_.stencils()) {
        for (int e = 0; e < kind.count(); ++e) {
            const auto [low, high] = std::ranges::minmax(kind[e]);
            for (const int v : kind[e]) {
                if (!is_held(model_, v)) continue;
                VertexRange& range = seen_by_[at(model_.strips.strip_of(v))];
                range = {std::min(range.begin, low), std::max(range.end, high + 1)};
            }
        }
    }
}

HeldSums::VertexRange HeldSums::seen_by(const Region& region) const {
    VertexRange all = seen_by_[at(region.begin)];
    for (int s = region.begin; s < region.end; ++s) {
        all.begin = std::min(all.begin, seen_by_[at(s)].begin);
        all.end = std::max(all.end, seen_by_[at(s)].end);
    }
    return all;
}

void HeldSums::fill_runs(const std::vector<HeldBody>& bodies) {
    const int runs = bodies_.run_count();
    const std::vector<double> shortest = shortest_at_held(model_, bodies);
    for (int r = 0; r < runs; ++r) {
        const HeldBody& body = bodies[at(bodies_.run(r).body)];
        double mass = 0.0;
        for (int v = body.whole.begin; v < body.whole.end; ++v) {
            if (!is_held(model_, v)) mass += model_.masses[at(v)];
        }
        std::fill_n(runs_.data() + WEFT_RUN_COLUMNS * r, WEFT_RUN_COLUMNS, r);
        ends_[at(r)] = body.hinge.from;
        ends_[at(runs + r)] = body.hinge.to;
        numbers_[at(r)] = static_cast<float>(model_.h * model_.h / mass);
        numbers_[at(runs + r)] = body.hinge.can_turn ? 1.0f : 0.0f;
        numbers_[at(2 * runs + r)] =
            static_cast<float>(kMostWay * shortest[at(bodies_.run(r).body)]);
    }
}

std::vector<Launch> HeldSums::sum(const Place& place) {
    std::vector<Launch> launches =
        moments_.sum(model_, place.positions, place.targets, place.starts);
    launches.push_back(launch(kernels::find_hinges, bodies_.runs().by_strip, place.positions, ends_,
                              hinges_, bodies_.run_count()));
    if (items_.count() == 0) return launches;
    std::ranges::move(derivatives_.gather(kInnerPhase, place.positions),
                      std::back_inserter(launches));
    launches.push_back(add_pulls(place));
    launches.push_back(holds_.add_columns(moments_.partials(), pulls_, {kParts, 1, kParts}));
    return launches;
}

Launch HeldSums::add_pulls(const Place& place) {
    const BodyColumns columns = holds_.columns();
    return launch(kernels::add_pulls, columns.by_strip, place.positions,
                  place.now ? *place.now : place.positions, items_.vertices(), derivatives_.sums(),
                  columns.members, columns.shares, columns.rows, moments_.origins(),
                  moments_.partials(), items_.count(), columns.count, place.now ? 1 : 0);
}

void HeldSums::add_sum_accesses(Step::Adding& task, const Region& region, const Place& place) {
    const auto [run, end_run] = bodies_.runs_in(region.begin, region.end);
    const VertexRange seen = seen_by(region);
    const VertexRange own{model_.vertices().item(region.begin), model_.vertices().item(region.end)};
    task.reads(place.positions, seen.begin, seen.end)
        .updates(pulls_, kParts * run, kParts * end_run);
    add_columns(task, hinges_, bodies_.run_count(), 2, run, end_run, true);
    moments_.add_sum_accesses(task, region, place.starts);
    add_end_reads(task, region, place.positions, seen);
    if (place.now == nullptr) return;
    task.reads(*place.now, own.begin, own.end);
    add_end_reads(task, region, *place.now, own);
}

/// What is held of a body may lie far from others of its parts.
void HeldSums::add_end_reads(Step::Adding& task, const Region& region, Buffer<float4>& positions,
                             VertexRange known) {
    const auto [run, end_run] = bodies_.runs_in(region.begin, region.end);
    std::vector<int> ends;
    for (const int column : {0, bodies_.run_count()})
        ends.insert(ends.end(), ends_.data() + column + run, ends_.data() + column + end_run);
    std::ranges::sort(ends);
    ends.erase(std::ranges::unique(ends).begin(), ends.end());
    for (const int v : ends) {
        if (v < known.begin || v >= known.end) task.reads(positions, v, v + 1);
    }
}

void HeldSums::add_reads(Step::Adding& task) {
    moments_.add_reads(task);
    task.reads(pulls_, 0, kParts * bodies_.run_count()).reads(hinges_, 0, 2 * bodies_.run_count());
}

void HeldSums::add_motion_accesses(Step::Adding& task, StripRange strips) {
    const auto [run, end_run] = bodies_.runs_in(strips.begin, strips.end);
    add_columns(task, motions_, bodies_.run_count() + 1, 3, run, end_run, true);
}

void HeldSums::add_motion_reads(Step::Adding& task) {
    task.reads(motions_, 0, static_cast<int>(motions_.count()));
}

}  // namespace weft
