#include "simulation/run/solver_maker.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "simulation/solver/async_iterates.h"
#include "simulation/solver/own_iterates.h"

namespace weft {

namespace {

std::unique_ptr<Solver> make_run_solver(Model& model, const SimulationOptions& options,
                                        std::size_t devices) {
    const bool by_kinds =
        options.plan == PlanKind::kAsync && options.async.tasks == AsyncSettings::Tasks::kKinds;
    auto solver = by_kinds ? make_solver_by_kinds(model) : options.make_solver(model);
    if (options.plan == PlanKind::kAsync) {
        const int iterates = std::max(options.iterates, static_cast<int>(devices));
        return std::make_unique<AsyncIterates>(model, std::move(solver), iterates, options.async);
    }
    if (options.iterates == 1) return solver;
    return std::make_unique<OwnIterates>(model, std::move(solver), options.iterates);
}

}  // namespace

LiveModel::SolverMaker solver_maker(const SimulationOptions& options, std::size_t devices) {
    return [options, devices](Model& model) { return make_run_solver(model, options, devices); };
}

}  // namespace weft
