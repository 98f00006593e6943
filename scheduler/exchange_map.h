#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace weft::scheduler {

// Asynchronous iterations (section 4.2 of the paper): devices work on copies of one iterate at the
// same time, and exchange what their tasks did by a map that is fixed beforehand.
// docs/asynchronous-gauss-seidel.md has the words and the reasons.

/// A part of the iterate, the smallest that is exchanged: cells [begin, end).
struct CellRange {
    int begin = 0;
    int end = 0;

    friend auto operator<=>(const CellRange&, const CellRange&) = default;
};

/// One task, as planned. Times are in any unit.
struct ExchangeTask {
    int iteration = 0;
    int stage = 0;  ///< it sees those of its iteration that have a smaller one
    /// Those of one kind >= 0 follow each other, whatever the window.
    int kind = -1;
    bool synchronous = false;  ///< it sees all before it, and all behind it see it
    int device = 0;
    double start = 0.0;
    double end = 0.0;
    std::vector<CellRange> reads;   ///< all that it looks at; what it writes is among it
    std::vector<CellRange> writes;  ///< and moves
    std::vector<int> after;         ///< tasks that must have ended, for other reasons
};

struct ExchangeProblem {
    std::vector<ExchangeTask> tasks;  ///< in the order of the synchronous solver
    int devices = 1;
    std::vector<int> owners;  ///< [cell] the device that has it in the end
    /// A task sees all that other devices did in iterations up to its own less this; 1: all that
    /// comes before it, as in the synchronous solver.
    int window = 2;
    bool iterations_in_turn = false;  ///< it sees all of earlier iterations, too
    double wait = 0.0;  ///< from a task's end until another device can have its result
    /// Who gets an owner's cell takes it as it is, and drops what it has done to it: the owner gets
    /// that, too. Else both are merged.
    bool dropping = true;
    int most_slots = 8;
};

/// Of a task: those before it that it must have seen, and cannot start before. Without those of its
/// own device.
std::vector<std::vector<int>> needed_tasks(const ExchangeProblem& problem);

/// Sets starts and ends: each device does its tasks in their order, as soon as what they need is
/// there. durations [task]
void plan_in_turn(ExchangeProblem& problem, const std::vector<double>& durations);

/// In which order tasks are given to devices: by rank_u, or by the one that keeps iterations in
/// sequence (ranks.h).
enum class PlacingRank { kUpward, kGaussSeidel };

/// Sets devices, too, by HEFT: each task goes where it ends earliest.
/// durations  [task][device], infinite where it cannot be
void place_by_rank(ExchangeProblem& problem, const std::vector<std::vector<double>>& durations,
                   PlacingRank rank);

/// One thing to do. A place is where a value of a cell lies: that many of the first ones are the
/// devices' iterates, the others slots.
struct ExchangeStep {
    enum class Kind {
        kTask,   ///< the task itself, on its device's iterate
        kCopy,   ///< to = from
        kMerge,  ///< to = to and from, merged; both started from `start`
    };
    Kind kind = Kind::kTask;
    int task = 0;  ///< it, or that which it is done for; the number of tasks: the end
    int device = 0;
    CellRange cells;
    int from = 0;
    int start = 0;
    int to = 0;
    /// Which values are meant, so that a map can be checked: 2 t + 1 is what task t left, 2 t what
    /// was merged for it, -1 what place 0 had in the beginning.
    int from_value = -1;
    int start_value = -1;
    int to_value = -1;  ///< that it leaves

    friend auto operator<=>(const ExchangeStep&, const ExchangeStep&) = default;
};

/// Who feeds whom: everything that is to be done, in an order in which one device could do it all.
/// At its begin and at its end, place 0 has all cells.
struct ExchangeMap {
    std::vector<ExchangeStep> steps;
    int slots = 0;
    int virtual_starts = 0;  ///< start points that no device was ever at
};

class TooFewSlots : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Throws std::logic_error for times at which a task starts before what it needs has ended, and
/// TooFewSlots.
ExchangeMap make_exchange_map(const ExchangeProblem& problem);

/// What is wrong with a map; empty: nothing. It does everything that the map says, and follows
/// which tasks each value contains:
/// - what is merged starts from the value that contains what both contain, and nothing else;
/// - what an owner has is never dropped;
/// - a task contains all that it needs (needed_tasks) and all that has reached it by plan, and
///   nothing else of other devices;
/// - no slot is written while somebody may still read it;
/// - in the end place 0 contains every task, once.
std::string find_fault(const ExchangeProblem& problem, const ExchangeMap& map);

}  // namespace weft::scheduler
