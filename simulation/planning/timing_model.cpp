#include "simulation/planning/timing_model.h"

#include <algorithm>

namespace weft {

namespace {

constexpr double kFirstLatency = 50e-6;  ///< [s] until it has been measured
/// A latency that has not been seen for so many frames is learnt anew.
constexpr int kOldFrames = 24;
constexpr double kFading = 0.95;  ///< of a latency, per frame in which it is hidden
constexpr double kShortestLatency = 1e-6, kLongestLatency = 5e-3;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

/// What a task got from other devices.
struct TimingModel::Arrival {
    double data = 0.0;   ///< when the last input from another device was made
    double ready = 0.0;  ///< when it has arrived, as far as is known
    int from = -1;
};

/// From the end of a task on one device to the start of one on another that needs its data [s].
struct TimingModel::Exchanges {
    std::vector<double> waited;  ///< where that device had nothing else to do
    std::vector<double> hidden;  ///< where it was busy meanwhile
};

TimingModel::TimingModel(std::size_t kinds, std::size_t devices)
    : devices_(devices),
      costs_(static_cast<std::uint32_t>(kinds), static_cast<std::uint32_t>(devices)),
      latency_(devices * devices, kFirstLatency),
      unseen_(latency_.size(), kOldFrames) {}

void TimingModel::set_latency(int from, int to, double seconds) {
    latency_[index(from, to)] = seconds;
    unseen_[index(from, to)] = kOldFrames;
}

void TimingModel::inherit(const TimingModel& other, const std::vector<int>& numbers) {
    for (std::size_t d = 0; d < numbers.size(); ++d) {
        const auto theirs = static_cast<std::uint32_t>(numbers[d]);
        for (std::uint32_t kind = 0; kind < costs_.kinds(); ++kind) {
            costs_.restore(kind, static_cast<std::uint32_t>(d), other.costs_.fit(kind, theirs));
        }
        for (std::size_t to = 0; to < numbers.size(); ++to) {
            set_latency(static_cast<int>(d), static_cast<int>(to),
                        other.latency(numbers[d], numbers[to]));
        }
    }
}

/// [instance][task]
std::vector<TimingModel::Arrival> TimingModel::find_arrivals(const Step& step,
                                                             const scheduler::Plan& plan,
                                                             const RunTimes& times,
                                                             int instances) const {
    const std::size_t count = step.tasks().size();
    const auto at = [&](int instance, int task) {
        return static_cast<std::size_t>(instance) * count + static_cast<std::size_t>(task);
    };
    std::vector<double> end(count * static_cast<std::size_t>(instances), 0.0);
    for (const auto& device : times.tasks) {
        for (const TaskTime& time : device) end[at(time.instance, time.task)] = time.end;
    }
    const auto device_of = [&](int task) {
        return static_cast<int>(plan.placements[static_cast<std::size_t>(task)].processor);
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
        for (const Dependency& d : step.dependencies()) note(i, d, at(i, d.from));
        if (i == 0) continue;
        for (const Dependency& d : step.carried()) note(i, d, at(i - 1, d.from));
    }
    return arrivals;
}

/// A task's cost runs from when it could have started (its device was free and its data were there)
/// to its end: so it holds what the device needs to get going. Where the device waited for another
/// one, the cost runs from the start, and all that lies between is the latency of the two: a device
/// that waits much would look slow otherwise, get less to do, and wait even more.
std::vector<double> TimingModel::learn(const Step& step, const scheduler::Plan& plan,
                                       const RunTimes& times, int instances) {
    std::vector<double> mean(step.tasks().size(), 0.0);
    const auto arrivals = find_arrivals(step, plan, times, instances);
    std::vector<Exchanges> exchanges(latency_.size());
    for (std::size_t device = 0; device < times.tasks.size(); ++device) {
        double free = times.start;
        for (const TaskTime& time : times.tasks[device]) {
            const auto number = static_cast<std::size_t>(time.task);
            const Arrival& arrival =
                arrivals[static_cast<std::size_t>(time.instance) * step.tasks().size() + number];
            const bool waited = arrival.from >= 0 && arrival.data > free;
            if (arrival.from >= 0) {
                Exchanges& seen = exchanges[index(arrival.from, static_cast<int>(device))];
                (waited ? seen.waited : seen.hidden).push_back(time.start - arrival.data);
            }
            const double could_start =
                waited ? time.start : std::min(time.start, std::max(free, arrival.ready));
            const double cost = time.end - could_start;
            mean[number] += cost / instances;
            const Task& task = step.tasks()[number];
            costs_.observe(static_cast<std::uint32_t>(task.body->kind),
                           static_cast<std::uint32_t>(device), static_cast<double>(task.items),
                           cost);
            free = time.end;
        }
    }
    costs_.refit();
    learn_latencies(exchanges);
    return mean;
}

/// Where no device waited, a latency is no longer than what passed without a wait; and it is taken
/// for shorter and shorter, or nobody would find out whether it still is as long as it was.
void TimingModel::learn_latencies(const std::vector<Exchanges>& exchanges) {
    for (std::size_t link = 0; link < exchanges.size(); ++link) {
        const auto& [waited, hidden] = exchanges[link];
        double& latency = latency_[link];
        unseen_[link] = std::min(unseen_[link] + 1, kOldFrames);
        if (!waited.empty()) {
            const double weight = unseen_[link] == kOldFrames ? 1.0 : 0.3;
            const double measured = std::clamp(median(waited), kShortestLatency, kLongestLatency);
            latency += weight * (measured - latency);
            unseen_[link] = 0;
        } else if (!hidden.empty()) {
            latency = std::max(kShortestLatency, kFading * std::min(latency, median(hidden)));
        }
    }
}

}  // namespace weft
