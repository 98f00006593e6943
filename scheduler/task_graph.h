#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace weft::scheduler {

using TaskId = std::uint32_t;
using ProcessorId = std::uint32_t;

/// The cost of a task on a processor that cannot run it.
inline constexpr double kCannotRun = std::numeric_limits<double>::infinity();

/// The graph is wrong: a cycle, a cost that is no time, a task that nobody can run, no task at all.
class GraphError : public std::runtime_error {
public:
    explicit GraphError(const std::string& message, std::vector<TaskId> tasks = {})
        : std::runtime_error(message), tasks_(std::move(tasks)) {}

    /// The tasks concerned; for a cycle, its tasks in order.
    const std::vector<TaskId>& tasks() const { return tasks_; }

private:
    std::vector<TaskId> tasks_;
};

/// What is known of a task besides its costs. Everything is optional.
struct TaskTraits {
    std::int32_t kind = -1;       ///< tasks of one kind >= 0 may be merged (merging.h)
    std::int32_t iteration = -1;  ///< solver iteration >= 0, for the Gauss-Seidel rank (ranks.h)
    std::string_view name = {};   ///< copied; an empty name takes no storage
};

/// One end of an edge, seen from its other end.
struct Arc {
    TaskId task = 0;
    double data = 0.0;  ///< size of the data that passes; a time where links keep their defaults
    double mean_time = 0.0;  ///< communication time, averaged over all ordered pairs of processors
};

/// Tasks with a cost per processor, and edges that carry data between them.
///
/// Passing an edge's data from processor p to q takes latency(p, q) + data / bandwidth(p, q), and
/// nothing at all if p == q. Times share one unit of the caller's choice (the runtime uses
/// seconds).
///
/// Use: clear(), set_link() if needed, add_task(), add_edge(), seal(); then plan. All storage is
/// kept by clear(), so a graph that is rebuilt every frame allocates nothing after the first
/// frames.
class TaskGraph {
public:
    explicit TaskGraph(ProcessorId processor_count = 1) { clear(processor_count); }

    /// Removes all tasks and edges and resets all links to latency 0, bandwidth 1.
    void clear(ProcessorId processor_count);

    /// Sets the link from one processor to another. latency >= 0, bandwidth > 0 (may be infinite).
    /// Seal again afterwards: averages over the links are taken there.
    void set_link(ProcessorId from, ProcessorId to, double latency, double bandwidth);
    /// Sets all links alike.
    void set_links(double latency, double bandwidth);

    /// Takes over all links of a graph with the same number of processors.
    void copy_links(const TaskGraph& other);

    /// Adds a task; cost holds one time >= 0 per processor, kCannotRun where it cannot run.
    TaskId add_task(std::span<const double> cost, const TaskTraits& traits = {});
    /// Replaces the costs of a task; allowed on a sealed graph, which stays sealed.
    void set_cost(TaskId task, std::span<const double> cost);
    /// `to` starts when `from` has ended and its data have arrived. Several edges between the same
    /// two tasks are allowed: all of their data must arrive.
    void add_edge(TaskId from, TaskId to, double data);

    /// Completes the graph: sorts the edges, finds the topological order. Needed before planning.
    /// Throws GraphError for an empty graph and for a cycle (naming its tasks).
    void seal();
    bool sealed() const { return sealed_; }

    TaskId task_count() const { return static_cast<TaskId>(kind_.size()); }
    ProcessorId processor_count() const { return processor_count_; }
    std::size_t edge_count() const { return edges_.size(); }

    double cost(TaskId task, ProcessorId p) const { return cost_[index(task, p)]; }
    /// [processor_count]
    std::span<const double> costs(TaskId task) const {
        return {cost_.data() + index(task, 0), processor_count_};
    }
    bool can_run(TaskId task, ProcessorId p) const { return cost(task, p) < kCannotRun; }
    /// Average cost over the processors that can run the task.
    double mean_cost(TaskId task) const { return mean_cost_[task]; }

    double latency(ProcessorId from, ProcessorId to) const { return link(from, to).latency; }
    double bandwidth(ProcessorId from, ProcessorId to) const { return link(from, to).bandwidth; }
    /// Time to pass `data` from one processor to another; 0 on the same one.
    double transfer_time(double data, ProcessorId from, ProcessorId to) const {
        return from == to ? 0.0 : link(from, to).latency + data / link(from, to).bandwidth;
    }
    /// The same for an edge's data; quicker where all links are alike.
    double transfer_time(const Arc& arc, ProcessorId from, ProcessorId to) const {
        if (!uniform_links_) return transfer_time(arc.data, from, to);
        return from == to ? 0.0 : arc.mean_time;
    }
    /// Average of transfer_time() over all ordered pairs of different processors; 0 with one
    /// processor.
    double mean_transfer_time(double data) const;

    // The rest needs a sealed graph; GraphError tells who asks an unsealed one for its order.
    std::span<const Arc> successors(TaskId t) const { return row(successor_, successor_begin_, t); }
    std::span<const Arc> predecessors(TaskId t) const {
        return row(predecessor_, predecessor_begin_, t);
    }
    /// Every task after its predecessors; among the ready ones the lowest id first.
    std::span<const TaskId> topological_order() const {
        if (!sealed_) refuse_unsealed();
        return order_;
    }
    /// Position of a task in topological_order().
    std::uint32_t topological_index(TaskId task) const { return order_index_[task]; }

    std::int32_t kind(TaskId task) const { return kind_[task]; }
    std::int32_t iteration(TaskId task) const { return iteration_[task]; }
    /// Empty for a task without a name.
    std::string_view name(TaskId task) const;
    /// The name, or "#<id>" without one: for messages.
    std::string label(TaskId task) const;

private:
    struct Edge {
        TaskId from, to;
        double data;
    };
    struct Link {
        double latency = 0.0, bandwidth = 1.0;
    };

    std::size_t index(TaskId task, ProcessorId p) const {
        return std::size_t{task} * processor_count_ + p;
    }
    const Link& link(ProcessorId from, ProcessorId to) const {
        return links_[std::size_t{from} * processor_count_ + to];
    }
    static std::span<const Arc> row(const std::vector<Arc>& arcs,
                                    const std::vector<std::uint32_t>& begin, TaskId task) {
        return {arcs.data() + begin[task], begin[task + 1] - begin[task]};
    }
    double checked_mean(std::span<const double> cost, TaskId task, std::string_view name) const;
    void fill_rows();
    void sort_topologically();
    [[noreturn]] void throw_cycle() const;
    [[noreturn]] static void refuse_unsealed();

    ProcessorId processor_count_ = 0;
    bool sealed_ = false;
    bool uniform_links_ = true;
    std::vector<Link> links_;        // [processor][processor]
    std::vector<double> cost_;       // [task][processor]
    std::vector<double> mean_cost_;  // [task]
    std::vector<std::int32_t> kind_, iteration_;
    std::vector<Edge> edges_;  // in the order in which they were added
    std::string names_;        // all names, one after the other
    std::vector<std::pair<std::uint32_t, std::uint32_t>> name_range_;  // up to the last named task

    std::vector<Arc> successor_, predecessor_;  // rows of arcs, in the order of edges_
    std::vector<std::uint32_t> successor_begin_, predecessor_begin_;
    std::vector<TaskId> order_;
    std::vector<std::uint32_t> order_index_;
    std::vector<std::uint32_t> missing_;  // working memory of the sort
    std::vector<TaskId> heap_;
};

}  // namespace weft::scheduler
