#include "scheduler/cell_places.h"

#include <utility>

namespace weft::scheduler {

CellSteps CellPlaces::steps(int first_task) {
    if (cell_.value(kFirstValue).is_kept) keep(kFirstValue, first_task, -1);
    const auto& events = cell_.events();
    for (std::size_t e = 0; e < events.size(); ++e) add(events[e], static_cast<int>(e));
    return std::move(steps_);
}

void CellPlaces::add(const CellEvent& event, int number) {
    switch (event.kind) {
        case CellEvent::Kind::kMade:
            if (cell_.value(event.result).is_kept) keep(event.result, event.task, number);
            return;
        case CellEvent::Kind::kTake:
            put(step(ExchangeStep::Kind::kCopy, event, event.place));
            return;
        case CellEvent::Kind::kMerge:
            put(step(ExchangeStep::Kind::kMerge, event, event.place));
            if (cell_.value(event.result).is_kept) keep(event.result, event.task, number);
            return;
        case CellEvent::Kind::kVirtual:
            ++steps_.virtual_starts;
            find_slot(event.result, number - 1);  // what it is made of is still read
            CellEvent copy = event;
            copy.input = event.base;
            copy.result = kNoValue;
            put(step(ExchangeStep::Kind::kCopy, copy, place(event.result)));
            put(step(ExchangeStep::Kind::kMerge, event, place(event.result)));
    }
}

ExchangeStep CellPlaces::step(ExchangeStep::Kind kind, const CellEvent& event, int to) {
    ExchangeStep made;
    made.kind = kind;
    made.task = event.task;
    made.device = event.device;
    made.from = event.direct_from >= 0 ? event.direct_from : place(event.input);
    made.from_value = cell_.value(event.input).number;
    made.to = to;
    made.to_value = made.from_value;
    if (kind == ExchangeStep::Kind::kCopy) return made;
    made.start = place(event.start);
    made.start_value = cell_.value(event.start).number;
    made.to_value = cell_.value(event.result).number;
    return made;
}

/// At once, by the device that made it: later it has gone on.
void CellPlaces::keep(ValueId id, int task, int number) {
    find_slot(id, number);
    const CellValue& value = cell_.value(id);
    ExchangeStep copy;
    copy.kind = ExchangeStep::Kind::kCopy;
    copy.task = task;
    copy.device = value.device;
    copy.from = value.device;
    copy.to = place(id);
    copy.from_value = copy.to_value = value.number;
    const bool is_left_by_task = value.number >= 0 && value.number % 2 != 0;
    (is_left_by_task ? steps_.behind : steps_.before)[task].push_back(copy);
}

/// One that nobody reads any more by then; if need be, one that somebody may have to wait for.
void CellPlaces::find_slot(ValueId id, int number) {
    CellValue& value = cell_.value(id);
    const auto is_over = [&](const CellValue& last) { return last.last_use <= number; };
    for (const bool at_leisure : {true, false}) {
        for (std::size_t s = 0; s < holds_.size(); ++s) {
            const CellValue& last = cell_.value(holds_[s]);
            const double safe = last.last_time + problem_.wait;
            if (!is_over(last) || (at_leisure && safe > value.time)) continue;
            holds_[s] = id;
            value.slot = static_cast<int>(s);
            return;
        }
        if (steps_.slots < problem_.most_slots) break;
    }
    if (steps_.slots == problem_.most_slots)
        throw TooFewSlots("an exchange map needs more slots than there are");
    value.slot = steps_.slots++;
    holds_.push_back(id);
}

}  // namespace weft::scheduler
