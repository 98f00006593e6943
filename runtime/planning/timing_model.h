#pragma once

#include <vector>

#include "runtime/executor.h"
#include "runtime/planning/row_items.h"
#include "scheduler/cost_drift.h"
#include "scheduler/cost_model.h"
#include "scheduler/task_graph.h"

namespace weft {

/// The way from one device to another: from the end of a task to the start of one that waits for
/// it pass latency + bytes / bandwidth.
struct Link {
    double latency = 0.0;    ///< [s]
    double bandwidth = 0.0;  ///< [bytes/s]; infinite where nothing is copied
};

/// What tasks take on each device, and what passes between the end of a task on one device and the
/// start of one that waits for it on another: learnt from all frames so far. Seconds.
class TimingModel {
public:
    TimingModel(std::size_t kinds, std::size_t devices);

    /// From now on the entries of rows count as items, too: those of the last frame learnt from.
    void count_rows_of(StepMaker& maker) { rows_ = RowItems(maker); }
    /// What the cost model counts of a task.
    double items(const Task& task) const { return rows_.of(task); }
    bool items_vary(const Task& task) const { return rows_.vary(task.body->kind); }
    /// Whether hoped() is anything else than task().
    bool forecasts_differ() const { return rows_.any_vary(); }
    double task(const Task& task, int device) const;
    /// The same, if what has changed for devices in use has not for this one: the shorter time.
    double hoped(const Task& task, int device) const;
    double latency(int from, int to) const { return links_[index(from, to)].latency; }
    const Link& link(int from, int to) const { return links_[index(from, to)]; }
    /// What is known from elsewhere, and is replaced as soon as it is measured here.
    void set_latency(int from, int to, double seconds);
    void set_link(int from, int to, const Link& link) { links_[index(from, to)] = link; }
    /// Takes over what another model knows of its devices `numbers`, in this order.
    void inherit(const TimingModel& other, const std::vector<int>& numbers);

    /// Learns from `instances` runs of a step by a plan. Gives what each task took on average.
    /// [task]
    std::vector<double> learn(const Step& step, const scheduler::Plan& plan, const RunTimes& times,
                              int instances);

    const scheduler::CostModel& costs() const { return costs_; }
    scheduler::CostModel& costs() { return costs_; }

private:
    struct Arrival;
    struct Exchanges;

    std::size_t index(int from, int to) const {
        return static_cast<std::size_t>(from) * devices_ + static_cast<std::size_t>(to);
    }
    std::vector<Arrival> find_arrivals(const Step& step, const scheduler::Plan& plan,
                                       const RunTimes& times, int instances) const;
    void learn_latencies(std::vector<Exchanges>& exchanges);
    void learn_bandwidths(const std::vector<CopyRecord>& copies);

    std::size_t devices_;
    scheduler::CostModel costs_;
    scheduler::CostDrift drift_;
    std::vector<Link> links_;  ///< [from][to]
    std::vector<int> unseen_;  ///< [from][to] frames since its latency was measured
    RowItems rows_;
};

}  // namespace weft
