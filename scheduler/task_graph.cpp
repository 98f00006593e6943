#include "scheduler/task_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace weft::scheduler {
namespace {

void check_link(double latency, double bandwidth) {
    if (!(latency >= 0.0) || !std::isfinite(latency)) {
        throw GraphError("latency must be a time >= 0, not " + std::to_string(latency));
    }
    if (!(bandwidth > 0.0)) {
        throw GraphError("bandwidth must be > 0, not " + std::to_string(bandwidth));
    }
}

std::string label_of(TaskId task, std::string_view name) {
    if (!name.empty()) return std::string(name);
    std::string label = "#";
    label += std::to_string(task);
    return label;
}

}  // namespace

void TaskGraph::clear(ProcessorId processor_count) {
    if (processor_count == 0) throw GraphError("a task graph needs at least one processor");
    processor_count_ = processor_count;
    sealed_ = false;
    uniform_links_ = true;
    links_.assign(std::size_t{processor_count} * processor_count, Link{});
    cost_.clear();
    mean_cost_.clear();
    kind_.clear();
    iteration_.clear();
    edges_.clear();
    names_.clear();
    name_range_.clear();
}

void TaskGraph::set_link(ProcessorId from, ProcessorId to, double latency, double bandwidth) {
    check_link(latency, bandwidth);
    links_.at(std::size_t{from} * processor_count_ + to) = {latency, bandwidth};
    uniform_links_ = false;
    sealed_ = false;
}

void TaskGraph::set_links(double latency, double bandwidth) {
    check_link(latency, bandwidth);
    std::fill(links_.begin(), links_.end(), Link{latency, bandwidth});
    uniform_links_ = true;
    sealed_ = false;
}

void TaskGraph::copy_links(const TaskGraph& other) {
    if (other.processor_count_ != processor_count_) {
        throw GraphError("links of " + std::to_string(other.processor_count_) +
                         " processors do not fit " + std::to_string(processor_count_));
    }
    links_ = other.links_;
    uniform_links_ = other.uniform_links_;
    sealed_ = false;
}

double TaskGraph::checked_mean(std::span<const double> cost, TaskId task,
                               std::string_view name) const {
    const auto refuse = [&](const std::string& why) {
        throw GraphError("task " + label_of(task, name) + ": " + why, {task});
    };
    if (cost.size() != processor_count_) {
        refuse(std::to_string(cost.size()) + " costs for " + std::to_string(processor_count_) +
               " processors");
    }
    double sum = 0.0;
    int able = 0;
    for (const double c : cost) {
        if (!(c >= 0.0)) refuse("a cost must be >= 0, not " + std::to_string(c));
        if (c == kCannotRun) continue;
        sum += c;
        ++able;
    }
    if (able == 0) refuse("no processor can run it");
    return sum / able;
}

TaskId TaskGraph::add_task(std::span<const double> cost, const TaskTraits& traits) {
    const TaskId task = task_count();
    const double mean = checked_mean(cost, task, traits.name);
    sealed_ = false;
    cost_.insert(cost_.end(), cost.begin(), cost.end());
    mean_cost_.push_back(mean);
    kind_.push_back(traits.kind);
    iteration_.push_back(traits.iteration);
    if (!traits.name.empty()) {
        name_range_.resize(task);
        name_range_.emplace_back(static_cast<std::uint32_t>(names_.size()),
                                 static_cast<std::uint32_t>(traits.name.size()));
        names_ += traits.name;
    }
    return task;
}

void TaskGraph::set_cost(TaskId task, std::span<const double> cost) {
    mean_cost_.at(task) = checked_mean(cost, task, name(task));
    std::copy(cost.begin(), cost.end(),
              cost_.begin() + static_cast<std::ptrdiff_t>(index(task, 0)));
}

void TaskGraph::add_edge(TaskId from, TaskId to, double data) {
    if (from >= task_count() || to >= task_count()) {
        throw GraphError("an edge names task #" + std::to_string(std::max(from, to)) +
                         ", but there are only " + std::to_string(task_count()) + " tasks");
    }
    if (!(data >= 0.0) || !std::isfinite(data)) {
        throw GraphError("edge " + label(from) + " -> " + label(to) +
                             ": data must be a finite number >= 0, not " + std::to_string(data),
                         {from, to});
    }
    sealed_ = false;
    edges_.push_back({from, to, data});
}

double TaskGraph::mean_transfer_time(double data) const {
    if (processor_count_ < 2) return 0.0;
    if (uniform_links_) return transfer_time(data, 0, 1);  // exact: no rounding from a sum
    double sum = 0.0;
    for (ProcessorId from = 0; from < processor_count_; ++from) {
        for (ProcessorId to = 0; to < processor_count_; ++to) sum += transfer_time(data, from, to);
    }
    return sum / (static_cast<double>(processor_count_ * (processor_count_ - 1)));
}

void TaskGraph::seal() {
    if (task_count() == 0) throw GraphError("the graph has no tasks");
    fill_rows();
    sort_topologically();
    sealed_ = true;
}

void TaskGraph::fill_rows() {
    const std::size_t n = task_count();
    successor_begin_.assign(n + 1, 0);
    predecessor_begin_.assign(n + 1, 0);
    for (const Edge& e : edges_) {
        ++successor_begin_[e.from];
        ++predecessor_begin_[e.to];
    }
    // Sums up to and including each row; filling from the back then turns them into beginnings.
    for (std::size_t t = 1; t <= n; ++t) {
        successor_begin_[t] += successor_begin_[t - 1];
        predecessor_begin_[t] += predecessor_begin_[t - 1];
    }
    successor_.resize(edges_.size());
    predecessor_.resize(edges_.size());
    for (std::size_t i = edges_.size(); i-- > 0;) {
        const Edge& e = edges_[i];
        const double mean = mean_transfer_time(e.data);
        successor_[--successor_begin_[e.from]] = {e.to, e.data, mean};
        predecessor_[--predecessor_begin_[e.to]] = {e.from, e.data, mean};
    }
}

void TaskGraph::sort_topologically() {
    const TaskId n = task_count();
    order_.clear();
    missing_.resize(n);
    for (TaskId t = 0; t < n; ++t) {
        missing_[t] = predecessor_begin_[t + 1] - predecessor_begin_[t];
    }
    heap_.clear();
    const auto lowest_first = std::greater<TaskId>();
    for (TaskId t = n; t-- > 0;) {
        if (missing_[t] == 0) heap_.push_back(t);
    }
    std::make_heap(heap_.begin(), heap_.end(), lowest_first);
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(), lowest_first);
        const TaskId task = heap_.back();
        heap_.pop_back();
        order_.push_back(task);
        for (const Arc& arc : successors(task)) {
            if (--missing_[arc.task] > 0) continue;
            heap_.push_back(arc.task);
            std::push_heap(heap_.begin(), heap_.end(), lowest_first);
        }
    }
    if (order_.size() < n) throw_cycle();
    order_index_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) order_index_[order_[i]] = i;
}

void TaskGraph::refuse_unsealed() {
    throw GraphError("the graph is not sealed: call seal() after the last task, edge and link");
}

void TaskGraph::throw_cycle() const {
    // Every task that was not ordered still misses a predecessor that was not ordered either:
    // walking from one to the next must run into a cycle.
    TaskId task = 0;
    while (missing_[task] == 0) ++task;
    std::vector<TaskId> path;
    while (std::find(path.begin(), path.end(), task) == path.end()) {
        path.push_back(task);
        for (const Arc& arc : predecessors(task)) {
            if (missing_[arc.task] > 0) {
                task = arc.task;
                break;
            }
        }
    }
    path.erase(path.begin(), std::find(path.begin(), path.end(), task));
    std::reverse(path.begin(), path.end());
    // Begin with the lowest id, so that the message does not depend on where the walk began.
    std::rotate(path.begin(), std::min_element(path.begin(), path.end()), path.end());
    std::string message = "the tasks form a cycle: ";
    for (const TaskId t : path) message += label(t) + " -> ";
    throw GraphError(message + label(path.front()), path);
}

std::string_view TaskGraph::name(TaskId task) const {
    if (task >= name_range_.size()) return {};
    const auto [begin, size] = name_range_[task];
    return std::string_view(names_).substr(begin, size);
}

std::string TaskGraph::label(TaskId task) const { return label_of(task, name(task)); }

}  // namespace weft::scheduler
