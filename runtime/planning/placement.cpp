#include "runtime/planning/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace weft {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

constexpr int kMostParts = 16;
/// Larger graphs take longer to plan than they gain.
constexpr int kMostTasks = 600;
constexpr int kStripsPerPart = 2;  ///< at least: a part has strips of its own to work on
/// At least so much less time than the best division must be possible.
constexpr double kLeastGain = 0.05;
/// The attempts are made anew when the least possible time has changed by so much.
constexpr double kChange = 0.1;

/// The cuts of so many parts of about the same size, the ends of all included.
std::set<int> equal_cuts(int strips, int parts) {
    std::set<int> cuts;
    for (int p = 0; p <= parts; ++p) cuts.insert(strips * p / parts);
    return cuts;
}

std::vector<int> between(const std::set<int>& cuts) {
    std::vector<int> parts;
    for (auto cut = cuts.begin(); std::next(cut) != cuts.end(); ++cut) {
        parts.push_back(*std::next(cut) - *cut);
    }
    return parts;
}

/// In parts instead of strips.
Division in_parts(const Division& share, const std::vector<int>& parts) {
    Division result{std::vector<int>(share.strips.size(), 0)};
    std::size_t part = 0;
    int end = 0;
    int covered = 0;
    for (std::size_t d = 0; d < share.strips.size(); ++d) {
        end += share.strips[d];
        for (; part < parts.size() && covered < end; ++part, ++result.strips[d]) {
            covered += parts[part];
        }
    }
    return result;
}

}  // namespace

Placement::Placement(StepGraphs& graphs, int strip_count, std::vector<int> devices)
    : graphs_(graphs),
      strip_count_(strip_count),
      devices_(std::move(devices)),
      device_count_(graphs.device_count()),
      kinds_(devices_, device_count_),
      part_count_(std::min(kMostParts, strip_count / kStripsPerPart)) {
    for (const int d : devices_) allowed_ |= 1U << d;
}

bool Placement::promises(const Step& step, const TimingModel& timing, double best) {
    if (!possible()) return false;
    kinds_.sum_up(step, timing);
    return kinds_.differ() && kinds_.least_time() < (1.0 - kLeastGain) * best;
}

/// Cut where a kind's share ends, a little before and behind it, and between, so that no part is
/// large.
std::vector<int> Placement::parts_for(const std::vector<Division>& shares) const {
    std::set<int> cuts = equal_cuts(strip_count_, part_count_);
    const int little = std::max(1, strip_count_ / (4 * part_count_));
    for (const Division& share : shares) {
        int end = 0;
        for (const int strips : share.strips) {
            end += strips;
            if (end == 0 || end == strip_count_) continue;
            for (const int cut : {end - little, end, end + little}) {
                cuts.insert(std::clamp(cut, 0, strip_count_));
            }
        }
    }
    return between(cuts);
}

/// Fewer parts where a part has many tasks.
void Placement::limit_parts(const Step& step) {
    const int regions = static_cast<int>(step.tasks().back().region) + 1;
    const int tasks_per_part = static_cast<int>(step.tasks().size()) / regions;
    part_count_ = std::clamp(kMostTasks / std::max(tasks_per_part, 1), 2, part_count_);
}

void Placement::begin(const TimingModel& timing) {
    const auto shares = kinds_.balance(strip_count_);
    shared_graph_ = graphs_.of(parts_for(shares));
    shares_.clear();
    for (const Division& share : shares) {
        shares_.push_back(in_parts(share, shared_graph_->parts()));
    }
    is_new_ = true;
    kinds_in_vain_ = 0;
    attempts_.clear();
    for (const int parts : {part_count_, part_count_ / 2}) {
        if (parts < 2) continue;
        attempts_.push_back({parts, scheduler::Heft::Rank::kUpward});
        attempts_.push_back({parts, scheduler::Heft::Rank::kGaussSeidel});
    }
    if (graph_ == nullptr) return;
    // The plan stays, at what it takes now.
    find_costs(priced(*graph_, timing), plan_);
    period_ = timetable_.period(graph_->graph(), plan_, cost_, graph_->carried());
}

void Placement::improve(const Step& step, const TimingModel& timing) {
    if (!possible()) return;
    kinds_.sum_up(step, timing);
    const double least = kinds_.least_time();
    if (std::abs(least - least_time_) > kChange * least) {
        least_time_ = least;
        limit_parts(step);
        begin(timing);
    }
    if (improve_shares(timing) || attempts_.empty()) return;
    try_heft(attempts_.back(), timing);
    attempts_.pop_back();
}

const scheduler::TaskGraph& Placement::priced(StepGraph& graph, const TimingModel& timing) const {
    return graph.price(timing, std::vector<unsigned>(graph.parts().size(), allowed_));
}

/// Of each task where the plan has it.
void Placement::find_costs(const scheduler::TaskGraph& graph, const scheduler::Plan& plan) {
    cost_.resize(graph.task_count());
    for (scheduler::TaskId t = 0; t < graph.task_count(); ++t) {
        cost_[t] = graph.cost(t, plan.placements[t].processor);
    }
}

/// Keeps the trial if it is better than the plan.
void Placement::keep_if_better(const std::shared_ptr<StepGraph>& graph, double period) {
    if (graph_ != nullptr && period >= period_) return;
    std::swap(trial_, plan_);
    period_ = period;
    graph_ = graph;
}

void Placement::try_heft(const Attempt& attempt, const TimingModel& timing) {
    const auto graph = graphs_.of(between(equal_cuts(strip_count_, attempt.parts)));
    const bool upward = attempt.rank == scheduler::Heft::Rank::kUpward;
    (upward ? upward_ : in_sequence_).schedule(priced(*graph, timing), trial_);
    find_costs(graph->graph(), trial_);
    keep_if_better(graph, timetable_.period(graph->graph(), trial_, cost_, graph->carried()));
}

/// Makes the trial from shares; gives its period.
double Placement::try_shares(const std::vector<Division>& shares) {
    const auto& tasks = shared_graph_->step().tasks();
    const scheduler::TaskGraph& graph = shared_graph_->graph();
    trial_.placements.resize(tasks.size());
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        auto left = static_cast<int>(tasks[t].region);
        const auto& parts = shares[static_cast<std::size_t>(tasks[t].body->kind)].strips;
        scheduler::ProcessorId device = 0;
        while (left >= parts[device]) left -= parts[device++];
        trial_.placements[t].processor = device;
    }
    first_ready_.order(graph, trial_);
    trial_.algorithm = trial_.found_by = "shares";
    trial_.proven_optimal = trial_.gave_up = false;
    find_costs(graph, trial_);
    return timetable_.period(graph, trial_, cost_, shared_graph_->carried());
}

/// Looks at one kind: whether giving a part of it to another device is better. False when that has
/// been in vain for all kinds.
bool Placement::improve_shares(const TimingModel& timing) {
    if (!is_new_ && kinds_in_vain_ == shares_.size()) return false;
    priced(*shared_graph_, timing);
    if (std::exchange(is_new_, false)) {
        shares_period_ = try_shares(shares_);
        keep_if_better(shared_graph_, shares_period_);
        return true;
    }
    const std::size_t kind = next_kind_++ % shares_.size();
    ++kinds_in_vain_;
    for (const Division& other : shares_[kind].neighbours(devices_)) {
        std::vector<Division> shares = shares_;
        shares[kind] = other;
        const double period = try_shares(shares);
        if (period >= shares_period_) continue;
        shares_ = std::move(shares);
        shares_period_ = period;
        keep_if_better(shared_graph_, period);
        kinds_in_vain_ = 0;
        --next_kind_;  // where something was gained, more may be
        break;
    }
    return true;
}

double Placement::predict(const TimingModel& timing) {
    if (graph_ == nullptr) return kNever;
    const scheduler::TaskGraph& graph = priced(*graph_, timing);
    find_costs(graph, plan_);
    return timetable_.makespan(graph, plan_, cost_);
}

std::vector<int> Placement::homes() const {
    std::vector<int> homes(static_cast<std::size_t>(strip_count_), -1);
    const auto& tasks = graph_->step().tasks();
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        // Exchanges between iterates count in pieces of strips instead.
        if (tasks[t].body->launches.front().segments.strip_count != strip_count_) continue;
        for (int s = tasks[t].first_strip; s < tasks[t].end_strip; ++s) {
            int& home = homes[static_cast<std::size_t>(s)];
            if (home < 0) home = static_cast<int>(plan_.placements[t].processor);
        }
    }
    std::ranges::replace(homes, -1, 0);  // nobody works on them
    return homes;
}

void Placement::fill(const TimingModel& timing, FramePlan& plan) {
    plan.graph = priced(*graph_, timing);
    find_costs(plan.graph, plan_);
    timetable_.set_times(plan.graph, cost_, plan_);
    bounds_.apply(plan.graph, plan_);
    plan.plan = plan_;
    plan.step = {graph_, &graph_->step()};
    plan.parts = graph_->parts();
    plan.homes.clear();
}

}  // namespace weft
