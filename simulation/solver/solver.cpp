#include "simulation/solver/solver.h"

#include <fmt/format.h>

#include <stdexcept>

#include "runtime/error.h"
#include "simulation/scene/method.h"
#include "simulation/solver/jpgd.h"
#include "simulation/solver/newton/newton.h"
#include "simulation/solver/sosd.h"
#include "simulation/solver/vbd.h"
#include "simulation/solver/xpbd.h"

namespace weft {

std::unique_ptr<Solver> make_solver(Model& model) {
    switch (model.scene.solver.method) {
        case Method::kXpbd:
            return make_xpbd_solver(model);
        case Method::kVbd:
            return make_vbd_solver(model);
        case Method::kSosd:
            return make_sosd_solver(model);
        case Method::kJpgd:
            return make_jpgd_solver(model);
        case Method::kNewton:
            return make_newton_solver(model);
    }
    throw std::logic_error("a method without a solver");
}

std::unique_ptr<Solver> make_solver_by_kinds(Model& model) {
    const Method method = model.scene.solver.method;
    if (method == Method::kXpbd) return make_xpbd_solver(model, XpbdTasks::kByFamily);
    throw UserError(
        fmt::format("--async tasks=kinds: only xpbd has tasks by kinds; {} has colours of vertices "
                    "that depend on each other within a strip",
                    name_of(method)));
}

}  // namespace weft
