#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "runtime/planning/division_search.h"
#include "runtime/planning/step_graph.h"
#include "scheduler/in_order.h"
#include "scheduler/timetable.h"
#include "simulation/solver/solver.h"

namespace weft {

/// What each kind of plan would take on a machine: seconds of one substep in a row of them,
/// infinite where there is no such plan.
struct Forecast {
    static constexpr double kNever = std::numeric_limits<double>::infinity();
    double single = kNever;
    double exact = kNever;
    double placed = kNever;
    std::vector<double> async;  ///< [makers of asynchronous steps]
};

/// Costs of asynchronous work from those of the same solver's: the kinds that it has besides copy
/// and merge vertices, which is taken for as long as `predict`, the first kind, takes for as many:
/// all of them do little but read and write positions.
TimingModel with_exchanges(const TimingModel& timing, std::size_t kinds, std::size_t devices);

/// Plans steps for machines with so many devices that need not be there. Every kind of plan gets
/// the division of the strips that suits it best.
class Forecaster {
public:
    /// maker   the synchronous solver
    /// asyncs  the same solver's asynchronous forms, for as many devices. All must outlive this.
    Forecaster(Solver& maker, const std::vector<Solver*>& asyncs, int strip_count, int devices);

    /// timing: costs of the synchronous solver's kinds on the devices, and links between them
    Forecast forecast(const TimingModel& timing);
    /// By a division that is given.
    double time_of(const Division& division, const TimingModel& timing) {
        return time(graphs_, division, timing);
    }
    /// Likewise, of one of the asynchronous forms.
    double async_time(std::size_t form, const Division& division, const TimingModel& timing);

private:
    double time(StepGraphs& graphs, const Division& division, const TimingModel& timing);
    double best_mixture(StepGraphs& graphs, const TimingModel& timing);
    double best_placement(const TimingModel& timing);

    int strip_count_;
    std::vector<int> devices_;
    std::size_t kinds_;
    StepGraphs graphs_;
    std::vector<std::unique_ptr<StepGraphs>> async_graphs_;
    scheduler::InOrder in_order_;
    scheduler::Timetable timetable_;
    scheduler::Plan plan_;
    std::vector<double> cost_;
};

}  // namespace weft
