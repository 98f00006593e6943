#include "simulation/planning/frame_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "runtime/clock.h"
#include "runtime/error.h"

namespace weft {

namespace {

constexpr double kFirstLatency = 50e-6;  ///< [s] until it has been measured
/// Frames that a correction is the median of: more than the cost model looks back on, so that a
/// device whose speed has changed gets new costs, and not its mixtures a bad name.
constexpr std::size_t kRatioWindow = 25;
constexpr std::size_t kMostCandidates = 64;
/// Another plan has to be predicted faster by this much before it replaces the one in use: less is
/// noise, and every change costs caches and, on discrete memory, copies.
constexpr double kHysteresis = 0.01;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

FramePlanner::FramePlanner(Solver& solver, int strip_count, const std::vector<Device*>& devices,
                           PlanKind kind, std::optional<Division> division)
    : solver_(solver),
      strip_count_(strip_count),
      devices_(devices),
      kind_(kind),
      fixed_(std::move(division)),
      costs_(static_cast<std::uint32_t>(solver.kinds().size()),
             static_cast<std::uint32_t>(devices.size())),
      latency_(devices.size() * devices.size(), kFirstLatency),
      mixture_(Division::proportional(strip_count, std::vector<double>(devices.size(), 1.0))) {
    if (!fixed_) return;
    const auto& given = fixed_->strips;
    const int sum = std::accumulate(given.begin(), given.end(), 0);
    if (given.size() == devices.size() && sum == strip_count) return;
    throw UserError("the division of the strips names " + std::to_string(given.size()) +
                    " devices and " + std::to_string(sum) + " strips; there are " +
                    std::to_string(devices.size()) + " devices and " + std::to_string(strip_count) +
                    " strips");
}

FramePlanner::Candidate& FramePlanner::candidate(const Division& division) {
    auto& known = candidates_[division];
    if (known) return *known;
    known = std::make_unique<Candidate>();
    known->step = solver_.make_step(division.cuts());
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

double FramePlanner::task_cost(const Task& task, int device) const {
    return costs_.predict(static_cast<std::uint32_t>(task.body->kind),
                          static_cast<std::uint32_t>(device), static_cast<double>(task.items));
}

void FramePlanner::refresh(const Candidate& candidate, scheduler::TaskGraph& graph, bool pinned) {
    cost_.resize(devices_.size());
    const auto& tasks = candidate.step.tasks();
    for (std::size_t t = 0; t < tasks.size(); ++t) {
        const int own = candidate.devices[static_cast<std::size_t>(tasks[t].region)];
        for (int d = 0; d < device_count(); ++d) {
            cost_[static_cast<std::size_t>(d)] =
                pinned && d != own ? scheduler::kCannotRun : task_cost(tasks[t], d);
        }
        graph.set_cost(static_cast<scheduler::TaskId>(t), cost_);
    }
    if (graph.sealed() && links_are_current(graph)) return;
    for (int p = 0; p < device_count(); ++p) {
        for (int q = 0; q < device_count(); ++q) {
            if (p == q) continue;
            graph.set_link(static_cast<scheduler::ProcessorId>(p),
                           static_cast<scheduler::ProcessorId>(q), latency(p, q),
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
            if (std::abs(used - latency(p, q)) > 0.1 * latency(p, q)) return false;
        }
    }
    return true;
}

double FramePlanner::correction(unsigned mask) const {
    const auto known = ratios_.find(mask);
    return known == ratios_.end() || known->second.empty() ? 1.0 : median(known->second);
}

double FramePlanner::predict(const Division& division) {
    Candidate& c = candidate(division);
    if (c.predicted_in != frame_) {
        refresh(c, c.pinned, true);
        heft_.schedule(c.pinned, trial_);
        c.makespan = trial_.makespan;
        c.predicted_in = frame_;
    }
    return c.makespan * correction(division.mask());
}

Division FramePlanner::best_single() {
    Division best;
    double best_time = std::numeric_limits<double>::infinity();
    for (int d = 0; d < device_count(); ++d) {
        Division single = Division::single(device_count(), strip_count_, d);
        // In use, it stays unless another is clearly faster.
        const double time = predict(single) * (last_ == single ? 1.0 - kHysteresis : 1.0);
        if (time >= best_time) continue;
        best_time = time;
        best = std::move(single);
    }
    return best;
}

/// One step of a hill climb per frame: the best of the mixture and its neighbours.
void FramePlanner::improve_mixture() {
    double best_time = predict(mixture_) * (1.0 - 0.2 * kHysteresis);
    Division best = mixture_;
    for (Division& neighbour : mixture_.neighbours()) {
        if (neighbour.devices().size() < 2) continue;
        const double time = predict(neighbour);
        if (time >= best_time) continue;
        best_time = time;
        best = std::move(neighbour);
    }
    mixture_ = std::move(best);
}

Division FramePlanner::choose() {
    if (fixed_) return *fixed_;
    const bool can_mix = device_count() > 1 && strip_count_ > 1;
    if (kind_ == PlanKind::kSingle || !can_mix) return best_single();
    improve_mixture();
    if (kind_ == PlanKind::kExact) return mixture_;
    Division single = best_single();
    const bool mixing = last_ && last_->devices().size() > 1;
    const double advantage = mixing ? 1.0 + kHysteresis : 1.0 - kHysteresis;
    return predict(mixture_) < predict(single) * advantage ? mixture_ : single;
}

void FramePlanner::place_anywhere(Candidate& c) {
    // The graph in which every task may run anywhere gives the bounds, and sometimes a better plan.
    refresh(c, c.free, false);
    heft_.schedule(c.free, trial_);
    if (trial_.makespan < current_.plan.makespan * (1.0 - 2.0 * kHysteresis)) {
        std::swap(trial_, current_.plan);
    }
    bounds_.apply(c.free, current_.plan);
}

void FramePlanner::fill(const Division& division) {
    Candidate& c = candidate(division);
    refresh(c, c.pinned, true);
    heft_.schedule(c.pinned, current_.plan);
    if (!fixed_ && division.devices().size() > 1)
        place_anywhere(c);
    else
        bounds_.apply(c.pinned, current_.plan);
    current_.step = &c.step;
    current_.division = division;
    current_.substep_time = current_.plan.makespan * correction(division.mask());
}

const FramePlan& FramePlanner::next() {
    const double start = now();
    ++frame_;
    if (candidates_.size() > kMostCandidates) candidates_.clear();
    const Division division = choose();
    fill(division);
    last_ = division;
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
        heft_.schedule(c.pinned, plan.plan);
        c.devices = division.devices();
    };
    // Cut in two and run by one device: so each kind of task is seen with few and with many items.
    for (int d = 0; d < device_count(); ++d) {
        if (device_count() > 1 && strip_count_ > 1)
            add(mixture_, d);
        else
            add(Division::single(device_count(), strip_count_, d), d);
    }
    if (device_count() > 1 && strip_count_ > 1) add(mixture_, -1);
    return plans;
}

void FramePlanner::learn(const FramePlan& plan, const RunTimes& times, int instances) {
    learn_tasks(plan, times, instances);
    costs_.refit();
    ++frame_;  // predictions from before are void
    if (plan.substep_time > 0.0) learn_correction(plan, times, instances);
    if (mixture_.devices().size() > 1 && !last_) {
        // Calibration has just begun to tell the devices' speeds apart.
        std::vector<double> speeds;
        for (int d = 0; d < device_count(); ++d) {
            const double time = predict(Division::single(device_count(), strip_count_, d));
            speeds.push_back(time > 0.0 ? 1.0 / time : 1.0);
        }
        mixture_ = Division::proportional(strip_count_, speeds);
    }
}

/// A task's cost runs from when it could have started (its device was free and its data were there)
/// to its end: so it holds what the device needs to get going. What lies before that, when a device
/// waited for another one, is the latency between the two.
void FramePlanner::learn_tasks(const FramePlan& plan, const RunTimes& times, int instances) {
    const auto& tasks = plan.step->tasks();
    const std::size_t count = tasks.size();
    const auto at = [&](int instance, int task) {
        return static_cast<std::size_t>(instance) * count + static_cast<std::size_t>(task);
    };
    std::vector<double> end(count * static_cast<std::size_t>(instances), 0.0);
    for (const auto& device : times.tasks) {
        for (const TaskTime& time : device) end[at(time.instance, time.task)] = time.end;
    }
    const auto device_of = [&](int task) {
        return static_cast<int>(plan.plan.placements[static_cast<std::size_t>(task)].processor);
    };

    struct Arrival {
        double data = 0.0;   ///< when the last input from another device was made
        double ready = 0.0;  ///< when it has arrived, as far as is known
        int from = -1;
    };
    std::vector<Arrival> arrivals(end.size());
    const auto note = [&](int instance, const Dependency& d, std::size_t from) {
        const int p = device_of(d.from);
        const int q = device_of(d.to);
        if (p == q) return;
        Arrival& arrival = arrivals[at(instance, d.to)];
        if (end[from] + latency(p, q) <= arrival.ready) return;
        arrival = {end[from], end[from] + latency(p, q), p};
    };
    for (int i = 0; i < instances; ++i) {
        for (const Dependency& d : plan.step->dependencies()) note(i, d, at(i, d.from));
        if (i == 0) continue;
        for (const Dependency& d : plan.step->carried()) note(i, d, at(i - 1, d.from));
    }

    std::vector<std::vector<double>> waits(latency_.size());
    for (std::size_t device = 0; device < times.tasks.size(); ++device) {
        double free = times.start;
        for (const TaskTime& time : times.tasks[device]) {
            const Arrival& arrival = arrivals[at(time.instance, time.task)];
            if (arrival.from >= 0 && arrival.data > free) {
                waits[index(arrival.from, static_cast<int>(device))].push_back(time.start -
                                                                               arrival.data);
            }
            const double could_start = std::min(time.start, std::max(free, arrival.ready));
            const Task& task = tasks[static_cast<std::size_t>(time.task)];
            costs_.observe(static_cast<std::uint32_t>(task.body->kind),
                           static_cast<std::uint32_t>(device), static_cast<double>(task.items),
                           time.end - could_start);
            free = time.end;
        }
    }
    for (std::size_t link = 0; link < waits.size(); ++link) {
        if (waits[link].empty()) continue;
        latency_[link] += 0.3 * (std::clamp(median(waits[link]), 1e-6, 5e-3) - latency_[link]);
    }
}

/// What a plan as a whole is off by (submission, caches that two devices share): the median ratio
/// of the last frames corrects the next prediction. Divisions out of use drift back to no
/// correction, or one bad spell would rule them out for good.
void FramePlanner::learn_correction(const FramePlan& plan, const RunTimes& times, int instances) {
    const double planned = plan.plan.makespan * instances;
    for (auto& [mask, ratios] : ratios_) {
        if (mask == plan.division.mask()) continue;
        for (double& ratio : ratios) ratio += 0.01 * (1.0 - ratio);
    }
    auto& ratios = ratios_[plan.division.mask()];
    ratios.push_back((times.end - times.start) / planned);
    if (ratios.size() > kRatioWindow) ratios.erase(ratios.begin());
}

}  // namespace weft
