#include "simulation/solver/solver.h"

#include <stdexcept>

#include "simulation/solver/vbd.h"
#include "simulation/solver/xpbd.h"

namespace weft {

std::unique_ptr<Solver> make_solver(Model& model) {
    switch (model.scene.solver.method) {
        case Method::kXpbd:
            return make_xpbd_solver(model);
        case Method::kVbd:
            return make_vbd_solver(model);
    }
    throw std::logic_error("a method without a solver");
}

}  // namespace weft
