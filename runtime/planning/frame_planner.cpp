#include "runtime/planning/frame_planner.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/error.h"

namespace weft {

namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();

/// What is known at the start may be from another hour or from devices half asleep, so what it
/// speaks against is tried all the same unless it takes more than half as long again.
constexpr scheduler::ProbeSettings kProbes{.start_frames = 1.0};

/// Frames in a row of what is chosen, awake, before anything else is tried: one may be a
/// disturbance.
constexpr int kFramesToSee = 2;

/// What is new may take so many times as long as what was settled on, per substep, and this [s]: a
/// device that wakes up, or a busy moment, is no mistake of the plan. Exchanges that were forecast
/// wrong were: on a GPU, placements took 30 times as long as forecast.
constexpr double kPatience = 3.0;
constexpr double kShortestPatience = 5e-3;

/// A change by a forecast is taken back at the first frame that takes so many times as long,
/// awake, as what was settled on before.
constexpr double kRegret = 1.25;

/// The part of the run's time that the search for better plans may take, and what it may take in
/// advance [s]: an attempt with contact takes milliseconds, and most of them find nothing.
constexpr double kSearchShare = 0.005;
constexpr double kSearchAdvance = 0.05;

/// Whether another device of another team is the same one, with more units: alone, it is better.
bool is_part_of_another(const std::vector<Device*>& devices, std::size_t d) {
    const DeviceInfo& own = devices[d]->info();
    return std::ranges::any_of(devices, [&](const Device* device) {
        const DeviceInfo& other = device->info();
        return other.team != own.team && other.kind == own.kind && other.driver == own.driver &&
               other.units > own.units;
    });
}

/// Whether such a device is in its team.
bool is_of_a_part(const std::vector<Device*>& devices, std::size_t d) {
    for (std::size_t other = 0; other < devices.size(); ++other) {
        const bool is_mate = devices[other]->info().team == devices[d]->info().team;
        if (is_mate && is_part_of_another(devices, other)) return true;
    }
    return false;
}

/// Of the first team.
std::size_t team_size(const std::vector<Device*>& devices) {
    return static_cast<std::size_t>(std::ranges::count_if(devices, [&](const Device* device) {
        return device->info().team == devices.front()->info().team;
    }));
}

}  // namespace

FramePlanner::FramePlanner(StepMaker& maker, int strip_count, const std::vector<Device*>& devices,
                           PlanKind kind, std::optional<Division> division)
    : devices_(devices),
      kind_(kind),
      fixed_(std::move(division)),
      feedback_(maker.kinds().size(), devices.size(), Candidates::most(devices.size())),
      candidates_(maker, strip_count, devices, feedback_.timing()),
      trials_(candidates_.count(), kProbes),
      search_credit_(kSearchAdvance) {
    feedback_.timing().count_rows_of(maker);
    if (kind_ == PlanKind::kPlaced && !candidates_.can_place()) kind_ = PlanKind::kAuto;
    if (kind_ == PlanKind::kExact && !candidates_.can_divide()) kind_ = PlanKind::kAuto;
    if (!fixed_) return;
    auto& given = fixed_->strips;
    // Who names the first team's shares leaves nothing to the others.
    if (given.size() == team_size(devices)) given.resize(devices.size(), 0);
    const int sum = std::accumulate(given.begin(), given.end(), 0);
    if (given.size() == devices.size() && sum == strip_count) return;
    throw UserError("the division of the strips names " + std::to_string(given.size()) +
                    " devices and " + std::to_string(sum) + " strips; there are " +
                    std::to_string(devices.size()) + " devices and " + std::to_string(strip_count) +
                    " strips");
}

/// What the kind of plan that is asked for leaves to choose from.
bool FramePlanner::is_wanted(std::uint32_t alternative) const {
    const bool can_mix = candidates_.can_mix();
    if (candidates_.is_single(alternative)) {
        return (kind_ == PlanKind::kAuto && !is_part_of_another(devices_, alternative)) ||
               kind_ == PlanKind::kSingle || !can_mix;
    }
    switch (kind_) {
        case PlanKind::kAuto:
            return true;
        case PlanKind::kExact:
        case PlanKind::kAsync:
            return !candidates_.is_placed(alternative);
        case PlanKind::kPlaced:
            return candidates_.is_placed(alternative);
        case PlanKind::kSingle:
            break;
    }
    return false;
}

/// Seconds of a substep and, with what has been learnt and what moving there takes, of a frame.
void FramePlanner::find_expectations() {
    const std::uint32_t count = candidates_.count();
    predicted_.assign(count, kImpossible);
    expected_.assign(count, kImpossible);
    hoped_.assign(count, kImpossible);
    for (std::uint32_t a = 0; a < count; ++a) {
        if (!is_wanted(a)) continue;
        predicted_[a] = candidates_.predict(a);
        if (last_instances_ == 0) continue;
        double hoped = candidates_.hope(a);
        if (a != current_.alternative && !where_.empty()) {
            const double moving = candidates_.moving_time(where_, a) / last_instances_;
            predicted_[a] += moving;
            hoped += moving;
        }
        expected_[a] = predicted_[a] * feedback_.slowdown(a) * last_instances_;
        hoped_[a] = hoped * feedback_.slowdown(a) * last_instances_;
    }
}

/// Everybody's share is no choice of its own: it is there for trials. And where one device has all
/// cores of a team, the team is seldom the better choice, while forecasts of it are often wrong, as
/// a mixture has many parts, and devices that sleep look slow or fast by chance.
bool FramePlanner::needs_trial(std::uint32_t alternative) const {
    if (candidates_.is_everybody(alternative)) return true;
    if (kind_ != PlanKind::kAuto || alternative == feedback_.choice().current()) return false;
    const unsigned mask = candidates_.devices_of(alternative);
    for (std::size_t d = 0; d < devices_.size(); ++d) {
        if ((mask >> d & 1U) != 0 && is_of_a_part(devices_, d)) return true;
    }
    return false;
}

/// As far as it has been paid for.
void FramePlanner::search() {
    const bool must_place = kind_ == PlanKind::kPlaced;
    if (search_credit_ < 0.0 && !must_place) return;
    const double start = now();
    if (kind_ != PlanKind::kSingle) candidates_.improve_mixtures();
    if (kind_ == PlanKind::kAuto || must_place) candidates_.improve_placements(must_place);
    search_credit_ -= now() - start;
}

std::uint32_t FramePlanner::choose() {
    search();
    find_expectations();
    std::vector<double>& choice = choosable_;
    choice = predicted_;
    for (std::uint32_t a = 0; a < choice.size(); ++a) {
        if (needs_trial(a)) choice[a] = kImpossible;
    }
    return feedback_.choice().choose(choice);
}

/// The plan to try instead of the chosen one, if it is time for that. Not before it has been seen
/// what the chosen one takes awake: a trial that has to beat a mere forecast is lost in a busy
/// moment.
std::uint32_t FramePlanner::or_trial(std::uint32_t chosen) {
    to_beat_ = expected_[chosen];
    if (!trials_.running() && frames_seen_ < kFramesToSee) return chosen;
    return trials_.next(chosen, expected_, hoped_).value_or(chosen);
}

const FramePlan& FramePlanner::next() {
    const double start = now();
    candidates_.forget_predictions();
    if (fixed_) {
        candidates_.fill(*fixed_, current_);
    } else {
        const std::uint32_t chosen = choose();
        candidates_.fill(or_trial(chosen), current_);
    }
    current_.slowdown = feedback_.slowdown(current_.alternative);
    current_.waking = (current_.devices() & ~awake_) != 0;
    current_.patience = patience();
    current_.plan_time = now() - start;
    return current_;
}

/// With the present plan.
double FramePlanner::patience() const {
    const std::uint32_t a = current_.alternative;
    if (!settled_ || a == settled_->alternative || a == last_) return kImpossible;
    return std::max(kPatience * settled_->substep, kShortestPatience);
}

std::vector<FramePlan> FramePlanner::calibration() {
    std::vector<FramePlan> plans;
    std::vector<bool> in_a_team(devices_.size(), false);
    for (std::size_t t = 0; t < candidates_.team_count(); ++t) {
        // Cut in two and run by one device: each kind of task is seen with few and with many items.
        for (const int d : candidates_.team(t)) {
            plans.push_back(candidates_.rehearsal(t, d));
            in_a_team[static_cast<std::size_t>(d)] = true;
        }
        plans.push_back(candidates_.rehearsal(t, std::nullopt));
    }
    for (std::uint32_t d = 0; d < devices_.size(); ++d) {
        if (in_a_team[d]) continue;
        FramePlan& plan = plans.emplace_back();
        candidates_.fill(d, plan);
        plan.calibrates = true;
    }
    return plans;
}

void FramePlanner::learn(const FramePlan& plan, const RunTimes& times, int instances) {
    feedback_.learn(plan, times, instances, trials_.running());
    candidates_.forget_predictions();
    if (plan.calibrates) return candidates_.balance();
    awake_ = plan.devices();
    where_ = plan.strip_devices();
    if (!trials_.running()) settle(plan, (times.end - times.start) / instances);
    last_ = plan.alternative;
    last_instances_ = instances;
    search_credit_ += kSearchShare * (times.end - times.start);
    frames_seen_ = plan.waking || trials_.running() ? 0 : frames_seen_ + 1;
    for (std::uint32_t a = 0; a < candidates_.count(); ++a) {
        if ((candidates_.devices_of(a) & ~awake_) == 0) trials_.used(a);
    }
    if (const auto better = trials_.end_frame(times.end - times.start, to_beat_)) {
        end_trial(*better);
    }
}

/// What was chosen by a forecast that has proved wrong is left at once for what was seen at work.
void FramePlanner::give_up(const FramePlan& plan, double seconds, double substep) {
    auto& choice = feedback_.choice();
    trials_.give_up(seconds);
    choice.given_up(plan.alternative, plan.plan.makespan, substep);
    if (choice.current() == plan.alternative) choice.prefer(settled_->alternative);
}

/// On what was chosen, once it is seen to be no worse than what was settled on before.
void FramePlanner::settle(const FramePlan& plan, double substep) {
    const bool is_new = settled_ && plan.alternative != settled_->alternative;
    if (is_new && plan.waking) return;
    if (is_new && substep > kRegret * settled_->substep) {
        auto& choice = feedback_.choice();
        choice.given_up(plan.alternative, plan.plan.makespan, substep);
        choice.prefer(settled_->alternative);
        return;
    }
    settled_ = Settled{plan.alternative, substep};
}

/// It was faster than the chosen one is expected to be: whatever made it look slow has passed.
void FramePlanner::end_trial(std::uint32_t alternative) {
    if (candidates_.is_everybody(alternative)) {
        candidates_.adopt_everybody(alternative);
        alternative = candidates_.mixture_beside(alternative);
    }
    // What has all cores may only have begun slowly: it has a return match.
    if (needs_trial(alternative)) trials_.doubt(feedback_.choice().current());
    feedback_.choice().forget(alternative);
    feedback_.choice().prefer(alternative);
}

}  // namespace weft
