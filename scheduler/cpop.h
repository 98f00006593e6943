#pragma once

#include "scheduler/planner.h"
#include "scheduler/ready_queue.h"
#include "scheduler/schedule_builder.h"

namespace weft::scheduler {

/// Critical path on a processor (Topcuoglu, Hariri, Wu 2002, section 4.2): priority is upward plus
/// downward rank; the tasks of one critical path all go to the processor that runs them fastest,
/// all others where they end earliest.
///
/// The path begins at the entry task of highest priority, and goes on to that successor that its
/// upward rank comes from; of equal ones the first edge counts. Where no processor can run the
/// whole path, its tasks are placed like all others.
class Cpop : public Planner {
public:
    std::string_view name() const override { return "cpop"; }
    void schedule(const TaskGraph& graph, Plan& plan) override;

private:
    void mark_critical_path(const TaskGraph& graph);
    ProcessorId fastest_on_path(const TaskGraph& graph) const;

    std::vector<double> upward_, priority_;
    std::vector<TaskId> path_;
    std::vector<bool> critical_;  // [task]
    ReadyQueue ready_;
    ScheduleBuilder builder_;
};

}  // namespace weft::scheduler
