#include "simulation/solver/held_bodies.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "kernels/bodies/free_bodies.h"
#include "kernels/bodies/held_bodies.h"
#include "simulation/families/convert.h"
#include "simulation/topology/components.h"

namespace weft {

namespace {

constexpr int kParts = WEFT_PULL_PARTS;
static_assert(kParts <= WEFT_MOMENT_PARTS, "they share their scratch");

/// How hard what obstacles push is held: as in body_momentum.cpp; and, where bodies may touch each
/// other, what others push and touch.
constexpr float kHeld = 50.0f;
constexpr float kFirmly = 1e30f;

/// Of the shortest way between what is held and what is free: bodies that would go further against
/// what holds them are not moved.
constexpr double kMostWay = 0.25;

/// How far the middle of cloth is from its hinge, of its farthest vertex, at least: of a sheet it
/// is half of it.
constexpr double kToOneSide = 0.25;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool is_held(const Model& model, int vertex) { return (*model.positions)[at(vertex)].w <= 0.0f; }

/// Whether a body goes as a whole. Solids do. Cloth does where it hangs to one side of a line or a
/// point that it turns about: between places that hold it, it sags by bending, and what pulls at
/// these says nothing of its middle. (Cloth held at opposite corners fell by a quarter less than
/// before.)
bool goes_as_a_whole(const Model& model, const FreeBodies::Whole& body, const BodyHinge& hinge) {
    if (is_solid(model, body.begin, body.end)) return true;
    if (!hinge.can_turn) return false;
    const auto place = [&](int v) { return to_vec3((*model.positions)[at(v)]); };
    const Vec3 from = place(hinge.from);
    const Vec3 line = place(hinge.to) - from;
    const double size = length(line);
    const Vec3 axis = size > 0.0 ? (1.0 / size) * line : Vec3{};
    Vec3 sum;
    double mass = 0.0;
    double farthest = 0.0;
    for (int v = body.begin; v < body.end; ++v) {
        const Vec3 r = place(v) - from;
        const Vec3 across = r - dot(r, axis) * axis;
        sum = sum + model.masses[at(v)] * across;
        mass += model.masses[at(v)];
        farthest = std::max(farthest, length(across));
    }
    return length(sum) > kToOneSide * mass * farthest;
}

std::vector<HeldBodies::Held> held_bodies(const Model& model) {
    const std::vector<int> begins = component_begins(model.vertex_count(), model.stencils());
    std::vector<HeldBodies::Held> bodies;
    for (std::size_t body = 0; body + 1 < begins.size(); ++body) {
        const int begin = begins[body];
        const int end = begins[body + 1];
        std::vector<int> held;
        for (int v = begin; v < end; ++v) {
            if (is_held(model, v)) held.push_back(v);
        }
        if (held.empty() || std::ssize(held) == end - begin) continue;
        const BodyHinge hinge = hinge_of(model, held);
        const FreeBodies::Whole whole{begin, end, hinge.from};
        if (goes_as_a_whole(model, whole, hinge)) bodies.push_back({whole, std::move(held), hinge});
    }
    return bodies;
}

std::vector<FreeBodies::Whole> wholes_of(const std::vector<HeldBodies::Held>& bodies) {
    std::vector<FreeBodies::Whole> wholes;
    for (const auto& body : bodies) wholes.push_back(body.whole);
    return wholes;
}

std::vector<int> held_vertices(const std::vector<HeldBodies::Held>& bodies) {
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
std::vector<double> shortest_at_held(const Model& model,
                                     const std::vector<HeldBodies::Held>& bodies) {
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
                    if (is_held(model, v)) continue;
                    double& least = shortest[at(body_of[at(v)])];
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

std::unique_ptr<HeldBodies> HeldBodies::of(Model& model, ContactResponse* contact, int kind) {
    const std::vector<Held> bodies = held_bodies(model);
    if (bodies.empty()) return nullptr;
    return std::make_unique<HeldBodies>(model, contact, bodies, kind);
}

HeldBodies::HeldBodies(Model& model, ContactResponse* contact, const std::vector<Held>& bodies,
                       int kind)
    : model_(model),
      contact_(contact),
      bodies_(model, wholes_of(bodies)),
      moments_(bodies_),
      items_(model.strips, held_vertices(bodies)),
      derivatives_(model, items_),
      holds_(model, wholes_of(bodies), counted_holds(model, items_)),
      runs_("held.runs", at(bodies_.column_count())),
      ends_("held.ends", 2 * at(bodies_.run_count())),
      numbers_("held.numbers", 3 * at(bodies_.run_count())),
      pulls_("held.pulls", at(kParts * (holds_.run_count() + holds_.most_runs()))),
      hinges_("held.hinges", ends_.count()),
      motions_("held.motions", 3 * at(bodies_.run_count() + 1)),
      body_{"held", kind, {}} {
    find_seen();
    fill_runs(bodies);
    if (contact || model.obstacles) number_bodies();
}

void HeldBodies::find_seen() {
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

HeldBodies::VertexRange HeldBodies::seen_by(const Region& region) const {
    VertexRange all = seen_by_[at(region.begin)];
    for (int s = region.begin; s < region.end; ++s) {
        all.begin = std::min(all.begin, seen_by_[at(s)].begin);
        all.end = std::max(all.end, seen_by_[at(s)].end);
    }
    return all;
}

void HeldBodies::fill_runs(const std::vector<Held>& bodies) {
    const int runs = bodies_.run_count();
    const std::vector<double> shortest = shortest_at_held(model_, bodies);
    for (int r = 0; r < runs; ++r) {
        const Held& body = bodies[at(bodies_.run(r).body)];
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

void HeldBodies::number_bodies() {
    const std::size_t count = model_.positions->count();
    seen_ = std::unique_ptr<Seen>(new Seen{{"held.seen", count}, {"held.bodies", count}});
    const std::vector<int> begins = component_begins(model_.vertex_count(), model_.stencils());
    for (std::size_t body = 0; body + 1 < begins.size(); ++body) {
        std::fill(seen_->bodies.data() + begins[body], seen_->bodies.data() + begins[body + 1],
                  static_cast<float>(body));
    }
}

void HeldBodies::look_at(Buffer<float4>& positions, Buffer<float4>& targets,
                         Buffer<float4>* starts) {
    positions_ = &positions;
    targets_ = &targets;
    body_.launches.clear();
    if (seen_) body_.launches.push_back(see(targets, starts));
    std::ranges::move(moments_.sum(model_, positions, seen_ ? seen_->targets : targets, starts),
                      std::back_inserter(body_.launches));
    body_.launches.push_back(launch(kernels::find_hinges, bodies_.runs().by_strip, positions, ends_,
                                    hinges_, bodies_.run_count()));
    add_pulls();
}

Launch HeldBodies::see(Buffer<float4>& targets, Buffer<float4>* starts) {
    const auto rows = contact_ ? std::optional(contact_->rows()) : std::nullopt;
    Buffer<int>& none = ends_;
    return launch(kernels::see_held, model_.vertices(), targets, starts ? *starts : targets,
                  seen_->bodies, rows ? rows->table.rows() : none,
                  rows ? rows->table.counts() : none, rows ? rows->corner0 : none,
                  rows ? rows->corner1 : none, rows ? rows->corner2 : none,
                  rows ? rows->corner3 : none, seen_->targets, contact_ ? 1 : 0);
}

void HeldBodies::add_pulls() {
    std::ranges::move(derivatives_.gather(kInnerPhase, *positions_),
                      std::back_inserter(body_.launches));
    const BodyColumns columns = holds_.columns();
    body_.launches.push_back(launch(kernels::add_pulls, columns.by_strip, *positions_,
                                    items_.vertices(), derivatives_.sums(), columns.members,
                                    columns.shares, columns.rows, moments_.origins(),
                                    moments_.partials(), items_.count(), columns.count));
    body_.launches.push_back(holds_.add_columns(moments_.partials(), pulls_, {kParts, 1, kParts}));
}

void HeldBodies::add_sums(Step& step, const std::vector<Region>& regions, int iteration) {
    for (const Region& region : regions) {
        if (!bodies_.reach_into(region.begin, region.end)) continue;
        const int first = model_.vertices().item(region.begin);
        const int last = model_.vertices().item(region.end);
        const VertexRange seen = seen_by(region);
        const auto [run, end_run] = bodies_.runs_in(region.begin, region.end);
        auto task = step.add(body_, iteration, region.strips(), region.id);
        task.reads(*targets_, first, last)
            .reads(*positions_, seen.begin, seen.end)
            .updates(pulls_, kParts * run, kParts * end_run);
        for (const int column : {0, bodies_.run_count()})
            task.updates(hinges_, column + run, column + end_run);
        moments_.add_sum_accesses(task, region);
        if (contact_) contact_->rows().add_reads(task, region.begin, region.end, first, last);
        add_end_reads(task, region);
    }
}

/// What is held of a body may lie far from others of its parts.
void HeldBodies::add_end_reads(Step::Adding& task, const Region& region) {
    const VertexRange seen = seen_by(region);
    const auto [run, end_run] = bodies_.runs_in(region.begin, region.end);
    std::vector<int> ends;
    for (const int column : {0, bodies_.run_count()})
        ends.insert(ends.end(), ends_.data() + column + run, ends_.data() + column + end_run);
    std::ranges::sort(ends);
    ends.erase(std::ranges::unique(ends).begin(), ends.end());
    for (const int v : ends) {
        if (v < seen.begin || v >= seen.end) task.reads(*positions_, v, v + 1);
    }
}

std::vector<Launch> HeldBodies::move(Buffer<float4>& deviations) {
    const BodyRuns runs = bodies_.runs();
    const BodyColumns columns = bodies_.columns();
    return {launch(kernels::solve_held, runs.by_strip, moments_.sums(), pulls_, runs.first,
                   runs.counts, hinges_, numbers_, motions_, bodies_.most_runs(),
                   bodies_.run_count(), contact_ ? kFirmly : kHeld),
            launch(kernels::move_held, columns.by_strip, *model_.positions, deviations,
                   *model_.velocities, motions_, columns.members, columns.shares, columns.rows,
                   runs_, static_cast<float>(1.0 / model_.h), bodies_.run_count())};
}

void HeldBodies::add_move_accesses(Step::Adding& task) {
    moments_.add_reads(task);
    task.reads(pulls_, 0, kParts * bodies_.run_count()).reads(hinges_, 0, 2 * bodies_.run_count());
}

}  // namespace weft
