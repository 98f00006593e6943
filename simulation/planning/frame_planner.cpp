#include "simulation/planning/frame_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/error.h"

namespace weft {

namespace {

constexpr std::size_t kMostCandidates = 64;
/// Another division of the mixture has to be predicted faster by this much: less is noise, and
/// every change costs caches and, on discrete memory, copies.
constexpr double kDivisionMargin = 0.002;
/// A division is worth a look of its own if a device has more strips more or less by it.
constexpr int kFarStrips = 2;

}  // namespace

FramePlanner::FramePlanner(Solver& solver, int strip_count, const std::vector<Device*>& devices,
                           PlanKind kind, std::optional<Division> division)
    : solver_(solver),
      strip_count_(strip_count),
      devices_(devices),
      kind_(kind),
      fixed_(std::move(division)),
      timing_(solver.kinds().size(), devices.size()),
      choice_(static_cast<std::uint32_t>(devices.size()) + 1),
      probes_(static_cast<std::uint32_t>(devices.size())),
      mixture_(equal_shares()) {
    if (!fixed_) return;
    const auto& given = fixed_->strips;
    const int sum = std::accumulate(given.begin(), given.end(), 0);
    if (given.size() == devices.size() && sum == strip_count) return;
    throw UserError("the division of the strips names " + std::to_string(given.size()) +
                    " devices and " + std::to_string(sum) + " strips; there are " +
                    std::to_string(devices.size()) + " devices and " + std::to_string(strip_count) +
                    " strips");
}

std::uint32_t FramePlanner::alternative_of(const Division& division) const {
    const auto devices = division.devices();
    return static_cast<std::uint32_t>(devices.size() == 1 ? devices[0] : device_count());
}

FramePlanner::Candidate& FramePlanner::candidate(const Division& division) {
    auto& known = candidates_[division];
    if (known) return *known;
    known = std::make_unique<Candidate>();
    known->step = solver_.make_step(division.partition());
    known->devices = division.devices();
    const auto processors = static_cast<scheduler::ProcessorId>(device_count());
    const std::vector<double> no_cost(devices_.size(), 0.0);
    for (scheduler::TaskGraph* graph : {&known->pinned, &known->free}) {
        graph->clear(processors);
        for (const Task& task : known->step.tasks()) {
            graph->add_task(no_cost, {.kind = task.body->kind, .iteration = task.iteration});
        }
        for (const Dependency& d : known->step.dependencies()) {
            graph->add_edge(static_cast<scheduler::TaskId>(d.from),
                            static_cast<scheduler::TaskId>(d.to), d.bytes);
        }
    }
    return *known;
}

void FramePlanner::refresh(const Candidate& candidate, scheduler::TaskGraph& graph, bool pinned) {
    cost_.resize(devices_.size());
    const auto& tasks = candidate.step.tasks();
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        const int own = own_device(candidate, t);
        for (int d = 0; d < device_count(); ++d) {
            cost_[static_cast<std::size_t>(d)] =
                pinned && d != own ? scheduler::kCannotRun : timing_.task(tasks[t], d);
        }
        graph.set_cost(static_cast<scheduler::TaskId>(t), cost_);
    }
    if (graph.sealed() && links_are_current(graph)) return;
    for (int p = 0; p < device_count(); ++p) {
        for (int q = 0; q < device_count(); ++q) {
            if (p == q) continue;
            graph.set_link(static_cast<scheduler::ProcessorId>(p),
                           static_cast<scheduler::ProcessorId>(q), timing_.latency(p, q),
                           std::numeric_limits<double>::infinity());
        }
    }
    graph.seal();
}

/// Sealing takes longer than planning, so small changes of latencies wait until they add up.
bool FramePlanner::links_are_current(const scheduler::TaskGraph& graph) const {
    for (int p = 0; p < device_count(); ++p) {
        for (int q = 0; q < device_count(); ++q) {
            if (p == q) continue;
            const double used = graph.latency(static_cast<scheduler::ProcessorId>(p),
                                              static_cast<scheduler::ProcessorId>(q));
            if (std::abs(used - timing_.latency(p, q)) > 0.1 * timing_.latency(p, q)) return false;
        }
    }
    return true;
}

double FramePlanner::predict(const Division& division) {
    Candidate& c = candidate(division);
    if (c.predicted_in != frame_) {
        refresh(c, c.pinned, true);
        c.makespan = in_order_.makespan(c.pinned);
        c.predicted_in = frame_;
    }
    return c.makespan;
}

double FramePlanner::expect(const Division& division) {
    return predict(division) * choice_.correction(alternative_of(division));
}

/// One step of a hill climb per frame: the best of the mixture, its neighbours and, where that is
/// far away (speeds have changed), what the speeds suggest.
void FramePlanner::improve_mixture() {
    double best_time = predict(mixture_) * (1.0 - kDivisionMargin);
    std::vector<Division> others = mixture_.neighbours();
    Division by_speed = divide_by_speed();
    if (by_speed.distance(mixture_) > kFarStrips) others.push_back(std::move(by_speed));
    for (Division& other : others) {
        if (other.devices().size() < 2) continue;
        const double time = predict(other);
        if (time >= best_time) continue;
        best_time = time;
        mixture_ = std::move(other);
    }
}

Division FramePlanner::choose() {
    constexpr double kOutOfQuestion = std::numeric_limits<double>::infinity();
    if (fixed_) return *fixed_;
    if (can_mix() && kind_ != PlanKind::kSingle) improve_mixture();
    if (can_mix() && kind_ == PlanKind::kExact) return mixture_;
    predicted_.clear();
    for (int d = 0; d < device_count(); ++d) predicted_.push_back(predict(single(d)));
    const bool mix = can_mix() && kind_ == PlanKind::kAuto;
    predicted_.push_back(mix ? predict(mixture_) : kOutOfQuestion);
    const int chosen = static_cast<int>(choice_.choose(predicted_));
    const Division division = chosen == device_count() ? mixture_ : single(chosen);
    return probe(division).value_or(division);
}

/// A plan that lets one of the devices that the chosen one leaves out do something, if it is time
/// to look at it again and the price can be paid.
std::optional<Division> FramePlanner::probe(const Division& chosen) {
    is_trial_ = false;
    if (last_instances_ == 0) return std::nullopt;  // what a frame takes is not known yet
    to_beat_ = expect(chosen);
    for (int d = 0; d < device_count(); ++d) {
        const auto device = static_cast<std::uint32_t>(d);
        if (chosen.strips[device] > 0 || !probes_.due(device, 0.0)) continue;
        for (const Division& trial : trials_of(d, chosen)) {
            const double price = expect(trial) / to_beat_ - 1.0;
            const double seconds = std::max(0.0, price) * last_frame_time_;
            if (!probes_.due(device, seconds)) continue;
            probes_.paid(device, seconds);
            is_trial_ = true;
            return trial;
        }
    }
    return std::nullopt;
}

/// Those that tell most come first. With an equal share a device shows what it can do: one that
/// gets little waits much, and looks slow. The best mixture known shows whether it deserves what
/// has been learnt of it.
std::vector<Division> FramePlanner::trials_of(int device, const Division& chosen) const {
    if (kind_ == PlanKind::kSingle || !can_mix()) return {single(device)};
    const auto d = static_cast<std::size_t>(device);
    std::vector<Division> trials;
    if (Division equal = equal_shares(); equal.strips[d] > mixture_.strips[d]) {
        trials.push_back(std::move(equal));
    }
    trials.push_back(mixture_.strips[d] > 0 ? mixture_ : with_one_strip_for(device, chosen));
    return trials;
}

/// From the device with the most strips: it has one to spare.
Division FramePlanner::with_one_strip_for(int device, const Division& chosen) const {
    Division division = chosen;
    --*std::ranges::max_element(division.strips);
    ++division.strips[static_cast<std::size_t>(device)];
    return division;
}

/// The solver's own order of tasks is made to hide the exchange; HEFT with insertion may know a
/// better one.
void FramePlanner::fill(const Division& division) {
    Candidate& c = candidate(division);
    refresh(c, c.pinned, true);
    in_order_.schedule(c.pinned, current_.plan);
    if (division.devices().size() > 1) {
        heft_.schedule(c.pinned, trial_);
        if (trial_.makespan < current_.plan.makespan * (1.0 - kDivisionMargin)) {
            std::swap(trial_, current_.plan);
        }
        refresh(c, c.free, false);
        bounds_.apply(c.free, current_.plan);
    } else {
        bounds_.apply(c.pinned, current_.plan);
    }
    current_.step = &c.step;
    current_.graph = &c.pinned;
    current_.division = division;
    current_.slowdown = choice_.correction(alternative_of(division)) * pace_();
}

const FramePlan& FramePlanner::next() {
    const double start = now();
    ++frame_;
    if (candidates_.size() > kMostCandidates) candidates_.clear();
    const Division division = choose();
    learn_pace();
    fill(division);
    current_.plan_time = now() - start;
    return current_;
}

std::vector<FramePlan> FramePlanner::calibration() {
    std::vector<FramePlan> plans;
    const auto add = [&](const Division& division, int device) {
        Candidate& c = candidate(division);
        if (device >= 0) std::fill(c.devices.begin(), c.devices.end(), device);
        refresh(c, c.pinned, true);
        FramePlan& plan = plans.emplace_back();
        plan.step = &c.step;
        plan.division = division;
        plan.calibrates = true;
        in_order_.schedule(c.pinned, plan.plan);
        c.devices = division.devices();
    };
    // Cut in two and run by one device: so each kind of task is seen with few and with many items.
    for (int d = 0; d < device_count(); ++d) add(can_mix() ? mixture_ : single(d), d);
    if (can_mix()) add(mixture_, -1);
    return plans;
}

void FramePlanner::learn(const FramePlan& plan, const RunTimes& times, int instances) {
    const auto task_times = timing_.learn(*plan.step, plan.plan, times, instances);
    ++frame_;  // predictions from before are void
    if (plan.calibrates) {
        balance_mixture();
        return;
    }
    last_frame_time_ = times.end - times.start;
    probes_.end_frame(last_frame_time_);
    for (const int d : plan.division.devices()) probes_.used(static_cast<std::uint32_t>(d));
    last_division_ = plan.division;
    last_was_trial_ = is_trial_;
    last_instances_ = instances;
    // Faster than the chosen one is expected to be: whatever made it look slow has passed.
    if (is_trial_ && last_frame_time_ < to_beat_ * pace_() * instances) {
        choice_.forget(alternative_of(plan.division));
    }
    choice_.measured(alternative_of(plan.division),
                     makespan_of(plan.division, task_times) * instances, last_frame_time_);
}

/// By the costs of now, which may have learnt from the last frame already; not by trials, of whose
/// plans too little is known. The pace concerns all plans alike, so it decides nothing. Measured on
/// a shared host: the median error of planned times was 7 to 22 % without it and 5 to 7 % with it,
/// which is what frames differ by from each other.
void FramePlanner::learn_pace() {
    if (last_instances_ == 0 || last_was_trial_) return;
    pace_.frame(expect(last_division_) * last_instances_, last_frame_time_);
}

/// What the plan would have been predicted to take had the costs of its tasks been known. Compared
/// with what it took, this is what the planner gets wrong (submission, jitter, substeps that
/// overlap); a wrong cost is the business of the cost model, and no bad name for the plan.
double FramePlanner::makespan_of(const Division& division, const std::vector<double>& task_times) {
    Candidate& c = candidate(division);
    for (std::size_t t = 0; t < task_times.size(); ++t) {
        cost_.assign(devices_.size(), scheduler::kCannotRun);
        cost_[static_cast<std::size_t>(own_device(c, t))] = task_times[t];
        c.pinned.set_cost(static_cast<scheduler::TaskId>(t), cost_);
    }
    return in_order_.makespan(c.pinned);
}

Division FramePlanner::divide_by_speed() {
    std::vector<double> speeds;
    for (int d = 0; d < device_count(); ++d) {
        const double time = predict(single(d));
        speeds.push_back(time > 0.0 ? 1.0 / time : 1.0);
    }
    return Division::proportional(strip_count_, speeds);
}

void FramePlanner::balance_mixture() { mixture_ = divide_by_speed(); }

}  // namespace weft
