#include "runtime/planning/timing_model.h"

#include <algorithm>
#include <limits>

#include "scheduler/order_statistics.h"

namespace weft {

namespace {

constexpr double kFirstLatency = 50e-6;  ///< [s] until it has been measured
/// A latency that has not been seen for so many frames is learnt anew.
constexpr int kOldFrames = 24;
/// Less than this part of the exchanges that waited says as much less: only the longest ones wait.
constexpr double kPlentyWaited = 0.25;
constexpr double kFading = 0.95;  ///< of a latency, per frame in which it is hidden
constexpr double kShortestLatency = 1e-6, kLongestLatency = 5e-3;
/// Shorter copies say more of the latency than of the bandwidth [bytes].
constexpr std::uint64_t kLongCopy = 32768;

}  // namespace

/// What a task got from other devices.
struct TimingModel::Arrival {
    double data = 0.0;     ///< when the last input from another device was made
    double ready = 0.0;    ///< when it has arrived, as far as is known
    double copying = 0.0;  ///< of that, what the copy itself takes
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
      drift_(costs_.kinds(), costs_.devices()),
      links_(devices * devices, {kFirstLatency, std::numeric_limits<double>::infinity()}),
      unseen_(links_.size(), kOldFrames) {}

/// Entries of rows are not as alike from frame to frame as other items are.
double TimingModel::task(const Task& task, int device) const {
    const auto kind = static_cast<std::uint32_t>(task.body->kind);
    const auto d = static_cast<std::uint32_t>(device);
    const double count = items(task);
    return items_vary(task) ? drift_.predict(costs_, kind, d, count)
                            : costs_.predict(kind, d, count);
}

double TimingModel::hoped(const Task& task, int device) const {
    const double own = costs_.predict(static_cast<std::uint32_t>(task.body->kind),
                                      static_cast<std::uint32_t>(device), items(task));
    return std::min(own, this->task(task, device));
}

void TimingModel::set_latency(int from, int to, double seconds) {
    links_[index(from, to)].latency = seconds;
    unseen_[index(from, to)] = kOldFrames;
}

void TimingModel::inherit(const TimingModel& other, const std::vector<int>& numbers) {
    for (std::size_t d = 0; d < numbers.size(); ++d) {
        const auto theirs = static_cast<std::uint32_t>(numbers[d]);
        for (std::uint32_t kind = 0; kind < std::min(costs_.kinds(), other.costs_.kinds());
             ++kind) {
            costs_.restore(kind, static_cast<std::uint32_t>(d), other.costs_.fit(kind, theirs));
        }
        for (std::size_t to = 0; to < numbers.size(); ++to) {
            const Link& known = other.link(numbers[d], numbers[to]);
            links_[index(static_cast<int>(d), static_cast<int>(to))] = known;
            unseen_[index(static_cast<int>(d), static_cast<int>(to))] = kOldFrames;
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
        const double copying = d.bytes / link(p, q).bandwidth;
        const double ready = end[from] + latency(p, q) + copying;
        if (ready > arrival.ready) arrival = {end[from], ready, copying, p};
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
    rows_.note();
    std::vector<double> mean(step.tasks().size(), 0.0);
    const auto arrivals = find_arrivals(step, plan, times, instances);
    std::vector<Exchanges> exchanges(links_.size());
    for (std::size_t device = 0; device < times.tasks.size(); ++device) {
        double free = times.start;
        for (const TaskTime& time : times.tasks[device]) {
            const auto number = static_cast<std::size_t>(time.task);
            const Arrival& arrival =
                arrivals[static_cast<std::size_t>(time.instance) * step.tasks().size() + number];
            const bool waited = arrival.from >= 0 && arrival.data > free;
            if (arrival.from >= 0) {
                Exchanges& seen = exchanges[index(arrival.from, static_cast<int>(device))];
                (waited ? seen.waited : seen.hidden)
                    .push_back(time.start - arrival.data - arrival.copying);
            }
            const double could_start =
                waited ? time.start : std::min(time.start, std::max(free, arrival.ready));
            const double cost = time.end - could_start;
            mean[number] += cost / instances;
            const Task& task = step.tasks()[number];
            costs_.observe(static_cast<std::uint32_t>(task.body->kind),
                           static_cast<std::uint32_t>(device), items(task), cost);
            free = time.end;
        }
    }
    costs_.refit();
    drift_.note(costs_);
    learn_latencies(exchanges);
    learn_bandwidths(times.copies);
    return mean;
}

/// Where no device waited, a latency is no longer than what passed without a wait; and it is taken
/// for shorter and shorter, or nobody would find out whether it still is as long as it was.
void TimingModel::learn_latencies(std::vector<Exchanges>& exchanges) {
    for (std::size_t link = 0; link < exchanges.size(); ++link) {
        auto& [waited, hidden] = exchanges[link];
        double& latency = links_[link].latency;
        unseen_[link] = std::min(unseen_[link] + 1, kOldFrames);
        if (!waited.empty()) {
            const double share = static_cast<double>(waited.size()) /
                                 static_cast<double>(waited.size() + hidden.size());
            const double weight =
                unseen_[link] == kOldFrames ? 1.0 : 0.3 * std::min(share / kPlentyWaited, 1.0);
            const double measured =
                std::clamp(scheduler::middle_of(waited), kShortestLatency, kLongestLatency);
            latency += weight * (measured - latency);
            unseen_[link] = 0;
        } else if (!hidden.empty()) {
            latency = std::max(kShortestLatency,
                               kFading * std::min(latency, scheduler::middle_of(hidden)));
        }
    }
}

/// By the rate of all long copies of the frame together.
void TimingModel::learn_bandwidths(const std::vector<CopyRecord>& copies) {
    constexpr double kWeight = 0.3;
    std::vector<double> bytes(links_.size(), 0.0), seconds(links_.size(), 0.0);
    for (const CopyRecord& copy : copies) {
        if (copy.bytes < kLongCopy) continue;
        bytes[index(copy.from, copy.to)] += static_cast<double>(copy.bytes);
        seconds[index(copy.from, copy.to)] += copy.end - copy.start;
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
        if (!(seconds[i] > 0.0)) continue;
        const double per_byte = seconds[i] / bytes[i];
        const double known = 1.0 / links_[i].bandwidth;  // 0: not yet
        links_[i].bandwidth = 1.0 / (known > 0.0 ? known + kWeight * (per_byte - known) : per_byte);
    }
}

}  // namespace weft
