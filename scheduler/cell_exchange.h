#pragma once

#include <vector>

#include "scheduler/cell_history.h"
#include "scheduler/exchange_map.h"

namespace weft::scheduler {

using ValueId = int;  ///< of a cell's value: a number in its exchange
inline constexpr ValueId kNoValue = -1;
inline constexpr ValueId kFirstValue = 0;  ///< what place 0 has in the beginning

/// What a cell was at some time.
struct CellValue {
    History history;
    int device = 0;  ///< that made it
    int number = -1;
    double time = 0.0;     ///< from when on it is there
    bool is_kept = false;  ///< in a slot, since somebody reads it after its device went on
    int slot = -1;
    int last_use = -1;  ///< event
    double last_time = 0.0;
};

/// What happens to one cell.
struct CellEvent {
    enum class Kind { kMade, kTake, kMerge, kVirtual };
    Kind kind = Kind::kMade;
    int task = 0;
    int device = 0;
    int place = 0;  ///< whose iterate changes
    ValueId result = kNoValue;
    ValueId base = kNoValue;
    ValueId input = kNoValue;
    ValueId start = kNoValue;
    int direct_from = -1;  ///< place in which the input still is
};

/// All that happens to one cell, in the order of the tasks' planned starts: which values there are,
/// and who makes which of which.
class CellExchange {
public:
    /// Both stay. needed: as needed_tasks() has it
    CellExchange(const ExchangeProblem& problem, const std::vector<std::vector<int>>& needed,
                 int cell);

    /// The next task that looks at the cell. writes: whether it moves it, too
    void run(int task, bool writes);
    /// Place 0 gets the owner's, which gets all, when all tasks have ended.
    void end(double time);

    const std::vector<CellEvent>& events() const { return events_; }
    CellValue& value(ValueId id) { return values_[static_cast<std::size_t>(id)]; }

private:
    ValueId& current(int device) { return current_[static_cast<std::size_t>(device)]; }
    const History& history(ValueId id) { return value(id).history; }
    ValueId add(const CellValue& made);
    bool contains_all_of(int device, ValueId id);
    void prepare(int device);
    ValueId oldest_for(int device);
    std::vector<ValueId> inputs_from(int q, int device);
    std::vector<ValueId> largest_of(const std::vector<ValueId>& list);
    std::vector<int> needed_now() const;
    void add_needed(int u, const std::vector<ValueId>& made, int device,
                    std::vector<ValueId>& list);
    void bring(int device, int from, ValueId input);
    ValueId start_for(int device, int from, ValueId input);
    void take(int device, ValueId input);
    void merge(int device, ValueId input, ValueId start);
    int place_with(ValueId id);
    void use(ValueId id);
    ValueId existing(const History& wanted);
    ValueId find(const History& wanted, int device);
    ValueId largest_within(const History& wanted, const History& known);
    ValueId join(ValueId a, ValueId b, int device);

    const ExchangeProblem& problem_;
    const std::vector<std::vector<int>>& needed_;
    int owner_;
    std::vector<ValueId> current_;               ///< [device] what its iterate has
    std::vector<std::vector<ValueId>> made_by_;  ///< [device] by its tasks
    std::vector<CellValue> values_;
    std::vector<CellEvent> events_;
    int task_ = 0;
    double start_ = 0.0;
    bool synchronous_ = false;
};

}  // namespace weft::scheduler
