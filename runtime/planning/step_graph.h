#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "runtime/planning/step_maker.h"
#include "runtime/planning/timing_model.h"
#include "scheduler/task_graph.h"
#include "scheduler/timetable.h"

namespace weft {

/// The step for one partition of the strips, and its task graph with the costs known now.
class StepGraph {
public:
    /// parts  how many strips each region has, in order
    StepGraph(StepMaker& maker, std::span<const int> parts, std::size_t devices);

    const Step& step() const { return step_; }
    const std::vector<int>& parts() const { return parts_; }
    /// The graph as it was priced last.
    const scheduler::TaskGraph& graph() const { return graph_; }
    /// From the tasks of one substep to those of the next.
    const std::vector<scheduler::CarriedEdge>& carried() const { return carried_; }

    /// Sets all costs and links to what is known now, and gives the graph, sealed.
    /// allowed  [region] a bit for each device that may run its tasks
    const scheduler::TaskGraph& price(const TimingModel& timing, std::span<const unsigned> allowed);

private:
    bool links_are_current(const TimingModel& timing) const;
    void set_links(const TimingModel& timing);

    std::vector<int> parts_;
    Step step_;
    scheduler::TaskGraph graph_;
    std::vector<scheduler::CarriedEdge> carried_;
    std::vector<double> cost_;
};

/// The graphs that were asked for, each made once; those that are in use are never forgotten.
class StepGraphs {
public:
    StepGraphs(StepMaker& maker, std::size_t devices) : maker_(maker), devices_(devices) {}

    std::size_t device_count() const { return devices_; }
    std::shared_ptr<StepGraph> of(const std::vector<int>& parts);
    /// Any one that was asked for, for what they have in common.
    const StepGraph* any() const { return known_.begin()->second.get(); }

private:
    void forget_unused();

    StepMaker& maker_;
    std::size_t devices_;
    std::map<std::vector<int>, std::shared_ptr<StepGraph>> known_;
};

}  // namespace weft
