#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/row_table.h"
#include "runtime/step.h"
#include "simulation/model/model.h"
#include "simulation/solver/partition.h"

namespace weft {

/// A way to advance a model by one substep, as tasks. It says what there is to do and in which
/// order the results are defined; which device does what is the planner's business.
class Solver {
public:
    virtual ~Solver() = default;

    /// Every body that steps are made of.
    virtual std::vector<const TaskBody*> bodies() const = 0;
    /// Names of the task kinds; TaskBody::kind is an index into it.
    virtual std::vector<std::string> kinds() const = 0;
    /// What the solver carries from substep to substep, besides the model's positions and
    /// velocities. All zeros at the beginning of a run: a substep then starts at x~, whatever the
    /// solver would guess from earlier ones, so that all solvers can be compared from one start.
    virtual std::vector<BufferStorage*> state() { return {}; }

    /// The buffers through which parts tell each other of their iterations: what a device has a
    /// copy of if it shall have an iterate of its own. Tasks access them by elements, not by
    /// tables. None: this solver's parts share all.
    virtual std::vector<Buffer<float4>*> iterate() { return {}; }
    /// How many there are, this solver's own included.
    virtual int iterate_count() const { return 1; }
    /// Copies of them that parts work on instead.
    virtual std::vector<const Buffer<float4>*> other_iterates() const { return {}; }
    /// Tables whose rows the tasks fill anew in every substep. Where one overflows, it grows, and
    /// the frame is done again from its start.
    virtual std::vector<RowTable*> tables() { return {}; }

    /// The task graph of one substep; region r of its tasks is part r (regions_of() in regions.h).
    virtual Step make_step(const Partition& partition) = 0;
};

/// The solver that the model's scene names.
std::unique_ptr<Solver> make_solver(Model& model);

}  // namespace weft
