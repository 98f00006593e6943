#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/planning/step_maker.h"
#include "simulation/model/model.h"

namespace weft {

class ContactResponse;

/// A way to advance a model by one substep, as tasks. It says what there is to do and in which
/// order the results are defined; which device does what is the planner's business.
class Solver : public StepMaker {
public:
    /// What the solver carries from substep to substep, besides the model's positions and
    /// velocities. All zeros at the beginning of a run: a substep then starts at x~, whatever the
    /// solver would guess from earlier ones, so that all solvers can be compared from one start.
    virtual std::vector<BufferStorage*> state() { return {}; }

    /// The buffers through which parts tell each other of their iterations: what a device has a
    /// copy of if it shall have an iterate of its own. [vertices], or [2 * vertices] for two values
    /// of each, one half behind the other. Tasks access them by elements, not by tables. None: this
    /// solver's parts share all.
    virtual std::vector<Buffer<float4>*> iterate() { return {}; }
    /// Contacts between bodies; null: this solver knows none, or the scene has none.
    virtual ContactResponse* contact() { return nullptr; }
    /// Copies of them that parts work on instead.
    virtual std::vector<const Buffer<float4>*> other_iterates() const { return {}; }
    /// What may be done asynchronously, by parts that do not wait for each other.
    struct Asynchrony {
        std::vector<int> kinds;  ///< of tasks; none: this solver has no asynchronous form
        std::vector<int> last;   ///< those of them that end an iteration, where they are apart
        /// Of each of two motions that meet. A solver that remembers how far it has moved needs 1.
        float weight = 0.5f;
        /// Of so many iterations each, the first ones stay in step.
        int round = 1;
        int in_step = 0;
    };
    virtual Asynchrony asynchrony() const { return {}; }
};

/// The solver that the model's scene names.
std::unique_ptr<Solver> make_solver(Model& model);

/// The same, with a task for each kind of work in an iteration (XPBD: each family of elements, and
/// obstacles) where they can be told apart. Throws UserError where they cannot.
std::unique_ptr<Solver> make_solver_by_kinds(Model& model);

}  // namespace weft
