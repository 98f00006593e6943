#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/partition.h"
#include "runtime/row_table.h"
#include "runtime/step.h"

namespace weft {

/// Work that can be planned: what there is to do, as a step for each partition of its strips. It
/// says in which order the results are defined; which device does what is the planner's business,
/// and results must not depend on it.
class StepMaker {
public:
    virtual ~StepMaker() = default;

    /// Every body that steps are made of.
    virtual std::vector<const TaskBody*> bodies() const = 0;
    /// Names of the task kinds; TaskBody::kind is an index into it.
    virtual std::vector<std::string> kinds() const = 0;
    /// The task graph of one step; region r of its tasks is part r (regions_of() in regions.h).
    virtual Step make_step(const Partition& partition) = 0;

    /// How many copies there are of what parts tell each other of, the maker's own included.
    virtual int iterate_count() const { return 1; }
    /// Tables whose rows the tasks fill anew in every step, in the order in which they do. Where
    /// one overflows, it grows, and the frame is done again from its start.
    virtual std::vector<RowTable*> tables() { return {}; }
    /// Whether a part of the strips can be left to another device. False: the step is the same for
    /// every partition, and all that can be chosen is a device for each of its tasks.
    virtual bool can_divide() const { return true; }
};

}  // namespace weft
