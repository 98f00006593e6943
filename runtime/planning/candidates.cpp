#include "runtime/planning/candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace weft {

namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostPredictions = 64;
/// Another division of the mixture has to be predicted faster by this much: less is noise, and
/// every change costs caches and, on discrete memory, copies.
constexpr double kDivisionMargin = 0.002;

/// By the teams' numbers; those of one device and those without strips to share are none.
std::vector<std::vector<int>> teams_among(const std::vector<Device*>& devices, int strip_count) {
    std::map<int, std::vector<int>> by_number;
    for (std::size_t d = 0; d < devices.size(); ++d) {
        by_number[devices[d]->info().team].push_back(static_cast<int>(d));
    }
    std::vector<std::vector<int>> teams;
    for (auto& [number, list] : by_number) {
        if (list.size() > 1 && strip_count > 1) teams.push_back(std::move(list));
    }
    return teams;
}

unsigned mask_of(const std::vector<int>& devices) {
    unsigned mask = 0;
    for (const int d : devices) mask |= 1U << d;
    return mask;
}

std::vector<int> parts_of(const Division& division) {
    std::vector<int> parts;
    for (const int d : division.devices()) {
        parts.push_back(division.strips[static_cast<std::size_t>(d)]);
    }
    return parts;
}

/// What a step's tasks write, all strips together.
double state_bytes(const Step& step) {
    std::set<const BufferStorage*> buffers;
    double bytes = 0.0;
    for (const Task& task : step.tasks()) {
        for (const Access& access : task.accesses) {
            if (!access.writes || !buffers.insert(access.buffer).second) continue;
            bytes += static_cast<double>(access.buffer->bytes());
        }
    }
    return bytes;
}

}  // namespace

Candidates::Candidates(StepMaker& maker, int strip_count, const std::vector<Device*>& devices,
                       const TimingModel& timing)
    : timing_(timing),
      device_count_(static_cast<std::uint32_t>(devices.size())),
      strip_count_(strip_count),
      can_divide_(maker.can_divide()),
      graphs_(maker, devices.size()) {
    for (const auto& list : teams_among(devices, strip_count)) {
        Team& team =
            teams_.emplace_back(Team{list, Division{}, Placement(graphs_, strip_count, list)});
        team.mixture = search(team).equal_shares();
    }
}

std::uint32_t Candidates::alternative_of(const Division& division) const {
    const auto devices = division.devices();
    if (devices.size() == 1) return static_cast<std::uint32_t>(devices[0]);
    for (std::size_t t = 0; t < teams_.size(); ++t) {
        if (std::ranges::count(teams_[t].devices, devices[0]) > 0) return mixture_of(t);
    }
    return mixture_of(0);
}

unsigned Candidates::devices_of(std::uint32_t alternative) const {
    if (is_single(alternative)) return 1U << alternative;
    const Team& team = team_of(alternative);
    if (is_mixture(alternative)) return team.mixture.mask();
    return mask_of(team.devices);
}

DivisionSearch Candidates::search(const Team& team) {
    return {static_cast<int>(device_count_), strip_count_, team.devices,
            [this](const Division& division) { return predict(division); }};
}

void Candidates::improve_mixtures() {
    if (!can_divide_) return;
    for (Team& team : teams_) search(team).improve(team.mixture, kDivisionMargin);
}

void Candidates::improve_placements(bool must) {
    for (Team& team : teams_) {
        const Prediction& mixture = prediction(team.mixture);
        double best = predict(team.mixture);
        for (const int d : team.devices) best = std::min(best, predict(static_cast<unsigned>(d)));
        if (must || !can_divide_ || team.placement.promises(mixture.graph->step(), timing_, best)) {
            team.placement.improve(mixture.graph->step(), timing_);
        }
    }
}

void Candidates::balance() {
    forget_predictions();
    for (Team& team : teams_) team.mixture = search(team).by_speed();
}

void Candidates::adopt_everybody(std::uint32_t alternative) {
    Team& team = team_of(alternative);
    team.mixture = search(team).by_speed();
}

/// Of those that are one.
Division Candidates::division_of(std::uint32_t alternative) {
    if (is_single(alternative)) {
        return Division::single(static_cast<int>(device_count_), strip_count_,
                                static_cast<int>(alternative));
    }
    const Team& team = team_of(alternative);
    return is_mixture(alternative) ? team.mixture : search(team).by_speed();
}

Candidates::Prediction& Candidates::prediction(const Division& division) {
    Prediction& known = predictions_[division];
    if (!known.graph) known.graph = graphs_.of(parts_of(division));
    return known;
}

const scheduler::TaskGraph& Candidates::pinned(const Division& division, StepGraph& graph) {
    std::vector<unsigned> allowed;
    for (const int d : division.devices()) allowed.push_back(1U << d);
    return graph.price(timing_, allowed);
}

double Candidates::predict(const Division& division) {
    Prediction& known = prediction(division);
    if (known.round != round_) {
        known.time = in_order_.makespan(pinned(division, *known.graph));
        known.round = round_;
    }
    return known.time;
}

double Candidates::predict(std::uint32_t alternative) {
    if (is_placed(alternative)) return team_of(alternative).placement.predict(timing_);
    if (!can_divide_ && !is_single(alternative)) return kImpossible;
    if (is_everybody(alternative)) {
        // The mixture itself where all have a share in it: there is nothing else to try.
        const Team& team = team_of(alternative);
        if (team.mixture.devices().size() == team.devices.size()) return kImpossible;
    }
    return predict(division_of(alternative));
}

double Candidates::hope(std::uint32_t alternative) {
    const double expected = predict(alternative);
    if (!timing_.forecasts_differ() || !is_single(alternative)) return expected;
    if (!std::isfinite(expected)) return expected;
    double sum = 0.0;
    const auto graph = prediction(division_of(alternative)).graph;
    for (const Task& task : graph->step().tasks()) {
        sum += timing_.hoped(task, static_cast<int>(alternative));
    }
    return std::min(sum, expected);
}

std::vector<int> Candidates::homes_of(std::uint32_t alternative) {
    if (is_placed(alternative)) return team_of(alternative).placement.homes();
    const Division division = division_of(alternative);
    std::vector<int> homes;
    for (std::size_t d = 0; d < division.strips.size(); ++d) {
        homes.insert(homes.end(), static_cast<std::size_t>(division.strips[d]),
                     static_cast<int>(d));
    }
    return homes;
}

bool Candidates::copies_data() const {
    for (int p = 0; p < static_cast<int>(device_count_); ++p) {
        for (int q = 0; q < static_cast<int>(device_count_); ++q) {
            if (p != q && std::isfinite(timing_.link(p, q).bandwidth)) return true;
        }
    }
    return false;
}

double Candidates::moving_time(const std::vector<int>& from, std::uint32_t alternative) {
    if (!copies_data() || !std::isfinite(predict(alternative))) return 0.0;
    const std::vector<int> to = homes_of(alternative);
    if (from.size() != to.size()) return 0.0;
    const double bytes = state_bytes(graphs_.any()->step()) / static_cast<double>(to.size());
    double seconds = 0.0;
    for (std::size_t strip = 0; strip < to.size(); ++strip) {
        if (from[strip] == to[strip]) continue;
        const Link& link = timing_.link(from[strip], to[strip]);
        const bool begins = strip == 0 || from[strip - 1] == to[strip - 1];
        seconds += (begins ? link.latency : 0.0) + bytes / link.bandwidth;
    }
    return seconds;
}

void Candidates::fill(std::uint32_t alternative, FramePlan& plan) {
    if (predictions_.size() > kMostPredictions) predictions_.clear();
    if (is_placed(alternative))
        team_of(alternative).placement.fill(timing_, plan);
    else
        fill(division_of(alternative), plan);
    plan.alternative = alternative;
}

/// The step's own order of tasks is made to hide the exchange; HEFT with insertion may know a
/// better one.
void Candidates::fill(const Division& division, FramePlan& plan) {
    const auto graph = prediction(division).graph;
    plan.graph = pinned(division, *graph);
    in_order_.schedule(plan.graph, plan.plan);
    plan.step = {graph, &graph->step()};
    plan.parts = graph->parts();
    plan.homes = division.devices();
    plan.alternative = alternative_of(division);
    if (plan.homes.size() == 1) return bounds_.apply(plan.graph, plan.plan);
    heft_.schedule(plan.graph, trial_);
    if (trial_.makespan < plan.plan.makespan * (1.0 - kDivisionMargin)) {
        std::swap(trial_, plan.plan);
    }
    unsigned anybody = 0;
    for (const Team& team : teams_) anybody |= mask_of(team.devices);
    const std::vector<unsigned> allowed(plan.parts.size(), anybody);
    bounds_.apply(graph->price(timing_, allowed), plan.plan);
}

FramePlan Candidates::rehearsal(std::size_t team, std::optional<int> device) {
    const Division& mixture = teams_[team].mixture;
    const auto graph = prediction(mixture).graph;
    FramePlan plan;
    plan.homes = mixture.devices();
    if (device) std::ranges::fill(plan.homes, *device);
    std::vector<unsigned> allowed;
    for (const int d : plan.homes) allowed.push_back(1U << d);
    plan.graph = graph->price(timing_, allowed);
    plan.step = {graph, &graph->step()};
    plan.parts = graph->parts();
    plan.calibrates = true;
    in_order_.schedule(plan.graph, plan.plan);
    return plan;
}

}  // namespace weft
