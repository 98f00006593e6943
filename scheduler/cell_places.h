#pragma once

#include <map>
#include <vector>

#include "scheduler/cell_exchange.h"

namespace weft::scheduler {

using StepsByTask = std::map<int, std::vector<ExchangeStep>>;

/// What has to be done to one cell.
struct CellSteps {
    StepsByTask before, behind;  ///< [task]
    int slots = 0;
    int virtual_starts = 0;
};

/// Finds where a cell's kept values lie, and so what has to be done.
class CellPlaces {
public:
    /// Both stay. The cell's exchange has ended.
    CellPlaces(const ExchangeProblem& problem, CellExchange& cell)
        : problem_(problem), cell_(cell) {}

    /// Once. first_task: of all, as planned. Throws TooFewSlots.
    CellSteps steps(int first_task);

private:
    int place(ValueId id) { return problem_.devices + cell_.value(id).slot; }
    void add(const CellEvent& event, int number);
    ExchangeStep step(ExchangeStep::Kind kind, const CellEvent& event, int to);
    void put(const ExchangeStep& made) { steps_.before[made.task].push_back(made); }
    void keep(ValueId id, int task, int number);
    void find_slot(ValueId id, int number);

    const ExchangeProblem& problem_;
    CellExchange& cell_;
    CellSteps steps_;
    std::vector<ValueId> holds_;  ///< [slot]
};

}  // namespace weft::scheduler
