#include "simulation/solver/solver.h"

#include <stdexcept>

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

}  // namespace weft
