#include "simulation/solver/touching_bodies.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "kernels/contact/groups.h"
#include "kernels/contact/strains.h"

namespace weft {

namespace {

constexpr int kRounds = 12;
constexpr int kRoundsOfSolids = 18;  ///< where they may touch others
/// More for each level of groups beyond the usual two, where there are sheets: solids, which are
/// led before the first iteration, too, have twice as many anyway.
constexpr int kLevels = 2;
constexpr int kRoundsPerLevel = 8;
/// Before the first iteration, where bodies touch obstacles alone: 12 do no better, and 3 worse.
constexpr int kFirstRoundsAlone = 6;
/// The rounds in which solids give way. Where they may touch others, none of the first ones: how
/// bodies are in each other says more there of how far they come than of what presses them, and a
/// strain that makes room for that stays.
struct Strains {
    int first, every;
    bool is_in(int round) const { return round >= first && (round - first) % every == 0; }
};
constexpr Strains kStrainsAlone{0, 3};
constexpr Strains kStrainsTogether{7, 2};

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The scene's bodies of which each free body has vertices.
std::vector<std::vector<int>> parts_of(const Model& model, const FreeBodies& bodies) {
    std::vector<std::vector<int>> parts(at(bodies.body_count()));
    int body = -1;
    for (int r = 0; r < bodies.run_count(); ++r) {
        const FreeBodies::Run& run = bodies.run(r);
        if (r == 0 || run.body != bodies.run(r - 1).body) ++body;
        for (int v = run.begin; v < run.end; ++v) {
            const SceneVertex vertex = model.scene_vertex(v);
            const auto is_in = [&](const BodyRange& b) { return b.has(vertex); };
            const auto part = std::ranges::find_if(model.bodies, is_in) - model.bodies.begin();
            parts[at(body)].push_back(static_cast<int>(part));
        }
    }
    for (std::vector<int>& list : parts) {
        std::ranges::sort(list);
        list.erase(std::ranges::unique(list).begin(), list.end());
    }
    return parts;
}

std::optional<ContactRows> rows_of(ContactResponse* contact) {
    if (contact == nullptr) return std::nullopt;
    return contact->rows();
}

}  // namespace

std::unique_ptr<TouchingBodies> TouchingBodies::of(Model& model, FreeBodies& bodies,
                                                   ContactResponse* contact,
                                                   Buffer<float>* multipliers, float held,
                                                   int first_kind) {
    auto resting = RestingBodies::of(model, bodies, rubbing_of(model).creep);
    if (!contact && !resting) return nullptr;
    return std::unique_ptr<TouchingBodies>(new TouchingBodies(
        model, bodies, contact, std::move(resting), multipliers, held, first_kind));
}

TouchingBodies::TouchingBodies(Model& model, FreeBodies& bodies, ContactResponse* contact,
                               std::unique_ptr<RestingBodies> resting, Buffer<float>* multipliers,
                               float held, int first_kind)
    : model_(model),
      bodies_(bodies),
      resting_(std::move(resting)),
      stops_(BodyStops::of(model, bodies, contact)),
      held_(held),
      has_multipliers_(multipliers != nullptr),
      is_rubbed_(rubbing_of(model).friction > 0 ||
                 (resting_ && bodies.has_solids() && model.obstacles->have_friction())),
      parts_(is_rubbed_ ? WEFT_RUBBED_BODY_PARTS : WEFT_BODY_PARTS),
      pushes_(rows_of(contact), bodies.columns(), rubbing_of(model), multipliers, model.h),
      groups_(contact ? &contact->motion().group(parts_of(model, bodies)) : nullptr),
      lag_count_(bodies.run_count() + bodies.most_runs()),
      partials_("touching.partials", at(parts_ * bodies.column_count())),
      lags_("touching.lags", at(parts_ * lag_count_)),
      body_of_("touching.body_of", at(model.vertex_count())),
      column_bodies_("touching.column_bodies", at(bodies.column_count())),
      first_run_("touching.first_run", at(bodies.body_count())),
      counts_("touching.counts", first_run_.count()),
      masses_("touching.masses", first_run_.count()),
      rests_("touching.rests", 7 * first_run_.count()),
      group_motions_("touching.group_motions", 3 * first_run_.count()),
      motions_("touching.motions", 2 * (first_run_.count() + 1)),
      strains_("touching.strains", motions_.count()),
      bearings_("touching.bearings", WEFT_BEARING_PARTS * (first_run_.count() + 1)),
      are_led_("touching.are_led", motions_.count() / 2),
      moments_(bodies, first_run_, counts_),
      begin_("touching.begin", model.strips.begin.size()) {
    number_bodies(model);
    std::fill(begin_.data() + 1, begin_.data() + begin_.count(), body_count());
    first_collect_ = collect_ = {"pushes", first_kind, {}};
    weigh_ = {"bodies", first_kind + 1, {moments_.weigh(all())}};
    steps_ = {"bodies", first_kind + 1, solve(0, 0)};
    for (int level = 0; level < level_count(); ++level) {
        steps_again_.push_back({"bodies", first_kind + 1, solve(1, level)});
    }
    solids_ = BodyStrains::of(model, bodies, body_of_);
    if (solids_) strain_steps_ = {"bodies", first_kind + 1, {solve_strains()}};
}

void TouchingBodies::number_bodies(const Model& model) {
    std::fill(body_of_.data(), body_of_.data() + model.vertex_count(), body_count());
    std::vector<double> masses(masses_.count());
    int body = -1;
    for (int r = 0; r < bodies_.run_count(); ++r) {
        const FreeBodies::Run& run = bodies_.run(r);
        if (r == 0 || run.body != bodies_.run(r - 1).body) first_run_[at(++body)] = r;
        counts_[at(body)] += 1.0f;
        std::fill_n(column_bodies_.data() + WEFT_RUN_COLUMNS * r, WEFT_RUN_COLUMNS, body);
        for (int v = run.begin; v < run.end; ++v) {
            body_of_[at(v)] = body;
            masses[at(body)] += model.masses[at(v)];
        }
    }
    std::ranges::transform(masses, masses_.data(), [](double m) { return static_cast<float>(m); });
}

std::vector<Launch> TouchingBodies::solve(int has_moved, int level) {
    std::vector<Launch> launches{launch(kernels::solve_bodies, all(), lags_, first_run_, counts_,
                                        masses_, moments_.moments(), motions_, strains_, rests_,
                                        bearings_, has_moved, is_rubbed_, groups_ ? 1 : 0,
                                        bodies_.most_runs(), lag_count_, body_count(), held_)};
    if (!groups_) return launches;
    launches.push_back(launch(kernels::solve_groups, all(), rests_, moments_.moments(), motions_,
                              groups_->firsts, groups_->counts, groups_->members, are_led_,
                              group_motions_, level, level_count(), body_count(), kInstance));
    launches.push_back(launch(kernels::add_groups, all(), motions_, bearings_, masses_, rests_,
                              moments_.moments(), group_motions_, groups_->leaders, is_rubbed_,
                              level, level_count(), body_count(), kInstance));
    return launches;
}

Launch TouchingBodies::solve_strains() {
    return launch(kernels::solve_strains, all(), lags_, solids_->virials(), first_run_, counts_,
                  masses_, solids_->stiffness(), moments_.moments(), motions_, strains_,
                  static_cast<float>(model_.h * model_.h), bodies_.most_runs(), lag_count_,
                  body_count());
}

std::vector<const TaskBody*> TouchingBodies::bodies() const {
    std::vector<const TaskBody*> list{&collect_, &weigh_, &steps_};
    for (const auto* bodies : {&sums_again_, &strained_sums_, &steps_again_}) {
        for (const TaskBody& body : *bodies) list.push_back(&body);
    }
    if (!first_collect_.launches.empty()) list.push_back(&first_collect_);
    if (solids_) list.insert(list.end(), {&strain_sums_, &strain_steps_});
    return list;
}

std::vector<Launch> TouchingBodies::sum(Buffer<float4>& positions, Buffer<float4>& targets,
                                        const ObstaclePushes& obstacles, int kind) {
    targets_ = &targets;
    obstacles_ = obstacles;
    collect_.launches = collect(positions);
    for (int level = 0; level < level_count(); ++level) {
        BodyPushes::Round round{.is_rubbed = is_rubbed_, .has_moved = 1, .level = level};
        sums_again_.push_back({"momentum", kind, sum_round(round)});
        round.is_strained = 1;
        strained_sums_.push_back({"momentum", kind, sum_round(round)});
    }
    strain_sums_ = {"momentum", kind,
                    sum_round({.is_rubbed = is_rubbed_, .has_moved = 1, .is_strain = 1})};
    return sum_round({.is_rubbed = is_rubbed_});
}

/// As moments see them.
Buffer<float4>* TouchingBodies::starts() {
    return resting_ ? &resting_->starts() : obstacles_.starts;
}

std::vector<Launch> TouchingBodies::collect(Buffer<float4>& positions) {
    std::vector<Launch> launches;
    if (resting_) launches.push_back(resting_->see(*targets_, obstacles_));
    Buffer<float4>& targets = resting_ ? resting_->targets() : *targets_;
    std::ranges::move(moments_.sums().sum(model_, positions, targets, starts()),
                      std::back_inserter(launches));
    if (solids_)
        std::ranges::move(solids_->sum(positions, moments_.sums().origins()),
                          std::back_inserter(launches));
    launches.push_back(pushes_.collect(positions, targets, body_of_, groups_));
    if (stops_) launches.push_back(stops_->collect(pushes_, positions, *targets_, body_count()));
    if (resting_)
        std::ranges::move(
            resting_->collect(pushes_, positions, *obstacles_.starts,
                              solids_ ? &solids_->gradients() : nullptr, body_count()),
            std::back_inserter(launches));
    return launches;
}

std::vector<Launch> TouchingBodies::sum_round(const BodyPushes::Round& round) {
    return {pushes_.add(column_bodies_, masses_, moments_.moments(), motions_, strains_, bearings_,
                        round, partials_),
            bodies_.add_columns(partials_, lags_,
                                {round.is_strain ? WEFT_STRAIN_PARTS : parts_, lag_count_, 1})};
}

void TouchingBodies::add_first_rounds(Step& step, const TaskBody& body,
                                      const std::vector<Region>& regions) {
    const int together = may_touch_others() ? kRoundsOfSolids : kRounds;
    const int rounds = groups_ ? together : kFirstRoundsAlone;
    add_all(step, first_collect_, body, regions, *model_.positions, {rounds, 0});
}

void TouchingBodies::add_rounds(Step& step, const TaskBody& body,
                                const std::vector<Region>& regions, Buffer<float4>& positions,
                                int iteration) {
    add_all(step, collect_, body, regions, positions, {round_count(), iteration});
}

bool TouchingBodies::is_solid(int body) const {
    return solids_ && solids_->stiffness()[at(body)] > 0.0f;
}

int TouchingBodies::round_count() const {
    int body = 0;
    while (body < body_count() && is_solid(body)) ++body;
    const bool has_sheets = body < body_count();
    const int more = has_sheets ? std::max(level_count() - kLevels, 0) : 0;
    const int fewest = solids_ && may_touch_others() ? kRoundsOfSolids : kRounds;
    return fewest + kRoundsPerLevel * more;
}

void TouchingBodies::add_all(Step& step, const TaskBody& collection, const TaskBody& body,
                             const std::vector<Region>& regions, Buffer<float4>& positions,
                             Rounds rounds) {
    const auto [count, iteration] = rounds;
    const auto for_each = [&](auto add) {
        for (const Region& region : regions) {
            if (bodies_.reach_into(region.begin, region.end)) add(region);
        }
    };
    for_each([&](const Region& region) {
        add_collection(step, collection, region, positions, iteration);
    });
    auto weighing = step.add(weigh_, iteration, {0, 1});
    moments_.add_weigh_accesses(weighing);
    const auto is_strain = [&](int round) {
        return solids_ && (may_touch_others() ? kStrainsTogether : kStrainsAlone).is_in(round);
    };
    for (int round = 0; round < count; ++round) {
        // The last round is of whole groups, as only these leave what they have in common exact.
        const std::size_t level = at((count - 1 - round) % level_count());
        const TaskBody& again = is_strain(round - 1) ? strained_sums_[level] : sums_again_[level];
        const TaskBody& sums = round == 0 ? body : again;
        for_each([&](const Region& region) { add_sum(step, sums, region, iteration); });
        add_steps(step, round == 0 ? steps_ : steps_again_[level], iteration);
        if (!is_strain(round)) continue;
        for_each([&](const Region& region) { add_sum(step, strain_sums_, region, iteration); });
        add_steps(step, strain_steps_, iteration);
    }
}

/// Contacts reach anywhere.
void TouchingBodies::add_collection(Step& step, const TaskBody& body, const Region& region,
                                    Buffer<float4>& positions, int iteration) {
    const int first = model_.vertices().item(region.begin);
    const int last = model_.vertices().item(region.end);
    auto task = step.add(body, iteration, region.strips(), region.id);
    task.reads(*targets_, first, last).reads(positions, 0, model_.vertex_count());
    pushes_.add_collect_accesses(task, region, first, last);
    moments_.sums().add_sum_accesses(task, region, starts());
    if (solids_) solids_->add_sum_accesses(task, region);
    if (stops_) stops_->add_collect_accesses(task, region.strips());
    if (resting_) resting_->add_collect_accesses(task, obstacles_, first, last);
}

void TouchingBodies::add_sum(Step& step, const TaskBody& body, const Region& region,
                             int iteration) {
    auto task = step.add(body, iteration, region.strips(), region.id);
    add_motion_accesses(task);
    task.reads(bearings_, 0, static_cast<int>(bearings_.count()));
    pushes_.add_sum_accesses(task, region);
    const auto [first_run, end_run] = bodies_.runs_in(region.begin, region.end);
    for (int part = 0; part < parts_; ++part) {
        task.updates(lags_, part * lag_count_ + first_run, part * lag_count_ + end_run);
    }
}

void TouchingBodies::add_steps(Step& step, const TaskBody& body, int iteration) {
    auto task = step.add(body, iteration, {0, 1});
    for (int part = 0; part < parts_; ++part) {
        const int first = part * lag_count_;
        task.reads(lags_, first, first + bodies_.run_count());
    }
    moments_.add_reads(task);
    if (solids_) solids_->add_reads(task);
    for (Buffer<float4>* written : {&motions_, &strains_, &rests_, &group_motions_, &bearings_}) {
        task.updates(*written, 0, static_cast<int>(written->count()));
    }
}

/// Solids start from what has held them up as wholes. What bears a sheet is not alike all over:
/// where solvers descend, it starts from what has held up each of its vertices, and piles that are
/// led as well would have that twice.
Launch TouchingBodies::lead(float less) {
    first_collect_.launches = collect(*model_.positions);
    for (int body = 0; body < body_count(); ++body) {
        are_led_[at(body)] = has_multipliers_ || is_solid(body) ? 1.0f : 0.0f;
    }
    return launch(kernels::lead_bodies, model_.vertices(), *model_.positions, motions_, strains_,
                  moments_.moments(), are_led_, body_of_, less, body_count());
}

Launch TouchingBodies::move(Model& model, Buffer<float4>& deviations) {
    const bool is_held = groups_ && rubbing_of(model).friction > 0.0;
    return launch(kernels::move_bodies, model_.vertices(), *model.positions, deviations,
                  *model.velocities, motions_, strains_, moments_.moments(), are_led_, body_of_,
                  group_motions_, groups_ ? groups_->leaders : body_of_,
                  static_cast<float>(1.0 / model.h), is_held ? held_ : 0.0f, level_count(),
                  body_count(), kInstance);
}

/// What tells where bodies have got to.
void TouchingBodies::add_motion_accesses(Step::Adding& task) {
    moments_.add_reads(task);
    task.reads(motions_, 0, static_cast<int>(motions_.count()));
    task.reads(strains_, 0, static_cast<int>(strains_.count()));
    task.reads(group_motions_, 0, static_cast<int>(group_motions_.count()));
}

}  // namespace weft
