#include "simulation/solver/solver.h"

#include <stdexcept>

#include "simulation/solver/xpbd.h"

namespace weft {

std::unique_ptr<Solver> make_solver(Model& model) {
    if (model.scene.solver.method == Method::kXpbd) return make_xpbd_solver(model);
    throw std::logic_error("the scene reader let a method through that has no solver");
}

}  // namespace weft
