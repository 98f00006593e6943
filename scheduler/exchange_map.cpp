#include "scheduler/exchange_map.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>

#include "scheduler/cell_history.h"

namespace weft::scheduler {

namespace {

using Id = int;  ///< of a value
constexpr Id kNone = -1;
constexpr Id kFirst = 0;  ///< what place 0 has in the beginning

/// What a cell was at some time.
struct Value {
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
struct Event {
    enum class Kind { kMade, kTake, kMerge, kVirtual };
    Kind kind = Kind::kMade;
    int task = 0;
    int device = 0;
    int place = 0;  ///< whose iterate changes
    Id result = kNone;
    Id base = kNone;
    Id input = kNone;
    Id start = kNone;
    int direct_from = -1;  ///< place in which the input still is
};

/// All that happens to one cell, in the order of the tasks' planned starts.
class CellExchange {
public:
    CellExchange(const ExchangeProblem& problem, const std::vector<std::vector<int>>& needed,
                 int cell)
        : problem_(problem),
          needed_(needed),
          owner_(problem.owners[static_cast<std::size_t>(cell)]),
          current_(static_cast<std::size_t>(problem.devices), kNone),
          made_by_(current_.size()) {
        values_.push_back({});
        current_[0] = kFirst;
    }

    void run(int task, bool writes) {
        const ExchangeTask& t = problem_.tasks[static_cast<std::size_t>(task)];
        task_ = task;
        start_ = t.start;
        synchronous_ = t.synchronous;
        prepare(t.device);
        if (!writes) return;
        Value made = value(current(t.device));
        made = {made.history, t.device, 2 * task + 1, t.end};
        made.history.add(task);
        const Id id = add(made);
        current(t.device) = id;
        made_by_[static_cast<std::size_t>(t.device)].push_back(id);
        events_.push_back({Event::Kind::kMade, task, t.device, t.device, id});
    }

    /// Place 0 gets the owner's, which gets all.
    void end(double time) {
        task_ = static_cast<int>(problem_.tasks.size());
        start_ = time;
        synchronous_ = true;
        if (std::ranges::all_of(made_by_, [](const auto& list) { return list.empty(); })) return;
        prepare(owner_);
        if (owner_ != 0 && current_[0] != current(owner_)) {
            events_.push_back({Event::Kind::kTake, task_, owner_, 0, kNone, kNone, current(owner_),
                               kNone, owner_});
        }
    }

    std::vector<Event>& events() { return events_; }
    Value& value(Id id) { return values_[static_cast<std::size_t>(id)]; }

private:
    Id& current(int device) { return current_[static_cast<std::size_t>(device)]; }
    const History& history(Id id) { return value(id).history; }
    Id add(const Value& made) {
        values_.push_back(made);
        return static_cast<Id>(values_.size()) - 1;
    }

    bool contains_all_of(int device, Id id) {
        return current(device) != kNone && history(id).within(history(current(device)));
    }

    void prepare(int device) {
        if (current(device) == kNone) take(device, oldest_for(device));
        std::vector<int> others;
        if (owner_ != device) others.push_back(owner_);
        for (int q = 0; q < problem_.devices; ++q) {
            if (q != device && q != owner_) others.push_back(q);
        }
        for (const int q : others) {
            for (const Id id : inputs_from(q, device)) bring(device, q, id);
        }
    }

    /// The first that a device gets. What another one, that it needs, has made of it is better.
    Id oldest_for(int device) {
        for (const int q : {owner_, 0}) {
            if (q == device) continue;
            const auto inputs = inputs_from(q, device);
            if (!inputs.empty()) return inputs.back();
        }
        return kFirst;
    }

    /// What there is of another device, and what there must be: of that, all that no other
    /// contains.
    std::vector<Id> inputs_from(int q, int device) {
        const auto& made = made_by_[static_cast<std::size_t>(q)];
        std::vector<Id> list;
        for (const Id id : made) {
            if (contains_all_of(device, id)) continue;
            if (synchronous_ || value(id).time + problem_.wait <= start_ * (1.0 + 1e-12)) {
                list.push_back(id);
            }
        }
        for (const int u : needed_now()) {
            if (problem_.tasks[static_cast<std::size_t>(u)].device != q) continue;
            add_needed(u, made, device, list);
        }
        return largest_of(list);
    }

    std::vector<Id> largest_of(const std::vector<Id>& list) {
        std::vector<Id> largest;
        for (const Id id : list) {
            const auto is_in = [&](Id other) {
                return other > id && history(id).within(history(other));
            };
            if (std::ranges::none_of(list, is_in)) largest.push_back(id);
        }
        return largest;
    }

    std::vector<int> needed_now() const {
        if (task_ == static_cast<int>(needed_.size())) return {};
        return needed_[static_cast<std::size_t>(task_)];
    }

    void add_needed(int u, const std::vector<Id>& made, int device, std::vector<Id>& list) {
        const auto has = [&](Id id) { return history(id).contains(u); };
        if (std::ranges::any_of(list, has)) return;
        if (current(device) != kNone && has(current(device))) return;
        const auto first = std::ranges::find_if(made, has);
        if (first != made.end()) list.push_back(*first);
    }

    void bring(int device, int from, Id input) {
        if (contains_all_of(device, input)) return;
        const bool drops = problem_.dropping && !synchronous_ && from == owner_;
        if (drops || history(current(device)).within(history(input))) return take(device, input);
        merge(device, input, start_for(device, from, input));
    }

    /// What both contain; mostly there was a time when the input's device was just there. Where it
    /// was not, having had two exchanges crosswise, its tasks are taken one by one: before each of
    /// them it was.
    Id start_for(int device, int from, Id input) {
        Id start = existing(both(history(current(device)), history(input)));
        if (start != kNone) return start;
        const std::vector<Id> made = made_by_[static_cast<std::size_t>(from)];
        for (const Id id : made) {
            if (id < input && !contains_all_of(device, id)) bring(device, from, id);
        }
        return find(both(history(current(device)), history(input)), device);
    }

    void take(int device, Id input) {
        Event event{Event::Kind::kTake, task_, device, device, kNone, kNone, input};
        event.direct_from = place_with(input);
        if (event.direct_from < 0) use(input);
        events_.push_back(event);
        current(device) = input;
    }

    void merge(int device, Id input, Id start) {
        Event event{Event::Kind::kMerge, task_, device, device, kNone,
                    current(device),     input, start};
        event.direct_from = place_with(input);
        if (event.direct_from < 0) use(input);
        use(start);
        const History all = either(history(current(device)), history(input));
        event.result = add({all, device, 2 * task_, start_});
        events_.push_back(event);
        current(device) = event.result;
    }

    /// Only synchronous tasks read from another's iterate, which has to wait for them.
    int place_with(Id id) {
        if (!synchronous_) return -1;
        const int device = value(id).device;
        return current(device) == id ? device : -1;
    }

    void use(Id id) {
        Value& used = value(id);
        used.is_kept = true;
        used.last_use = static_cast<int>(events_.size());
        used.last_time = start_;
    }

    Id existing(const History& wanted) {
        for (Id id = static_cast<Id>(values_.size()) - 1; id >= 0; --id) {
            if (history(id) == wanted) return id;
        }
        return kNone;
    }

    /// The value that contains just these tasks; made where there never was one.
    Id find(const History& wanted, int device) {
        if (const Id id = existing(wanted); id != kNone) return id;
        Id have = largest_within(wanted, {});
        while (!(history(have) == wanted)) {
            const Id more = largest_within(wanted, history(have));
            have = join(have, more, device);
        }
        return have;
    }

    /// By what it has more than another one.
    Id largest_within(const History& wanted, const History& known) {
        Id best = kFirst;
        int most = 0;
        for (Id id = 0; id < static_cast<Id>(values_.size()); ++id) {
            if (!history(id).within(wanted)) continue;
            const int more = history(id).count() - both(history(id), known).count();
            if (more > most) {
                best = id;
                most = more;
            }
        }
        if (most == 0 && wanted.count() > known.count()) {
            throw std::logic_error("exchange map: no value to make a start point of");
        }
        return best;
    }

    Id join(Id a, Id b, int device) {
        if (history(a).within(history(b))) return b;
        const Id start = find(both(history(a), history(b)), device);
        for (const Id id : {a, b, start}) use(id);
        Value made{either(history(a), history(b)), device, 2 * task_, start_};
        made.is_kept = true;
        const Id id = add(made);
        events_.push_back({Event::Kind::kVirtual, task_, device, device, id, a, b, start});
        return id;
    }

    const ExchangeProblem& problem_;
    const std::vector<std::vector<int>>& needed_;
    int owner_;
    std::vector<Id> current_;               ///< [device] what its iterate has
    std::vector<std::vector<Id>> made_by_;  ///< [device] by its tasks
    std::vector<Value> values_;
    std::vector<Event> events_;
    int task_ = 0;
    double start_ = 0.0;
    bool synchronous_ = false;
};

using StepsByTask = std::map<int, std::vector<ExchangeStep>>;

/// What has to be done to one cell.
struct CellSteps {
    StepsByTask before, behind;  ///< [task]
    int slots = 0;
    int virtual_starts = 0;
};

/// Finds where a cell's kept values lie.
class CellPlaces {
public:
    CellPlaces(const ExchangeProblem& problem, CellExchange& cell)
        : problem_(problem), cell_(cell) {}

    CellSteps steps(int first_task) {
        if (cell_.value(kFirst).is_kept) keep(kFirst, first_task, -1);
        const auto& events = cell_.events();
        for (std::size_t e = 0; e < events.size(); ++e) add(events[e], static_cast<int>(e));
        return std::move(steps_);
    }

private:
    int place(Id id) { return problem_.devices + cell_.value(id).slot; }

    void add(const Event& event, int number) {
        switch (event.kind) {
            case Event::Kind::kMade:
                if (cell_.value(event.result).is_kept) keep(event.result, event.task, number);
                return;
            case Event::Kind::kTake:
                put(step(ExchangeStep::Kind::kCopy, event, event.place));
                return;
            case Event::Kind::kMerge:
                put(step(ExchangeStep::Kind::kMerge, event, event.place));
                if (cell_.value(event.result).is_kept) keep(event.result, event.task, number);
                return;
            case Event::Kind::kVirtual:
                ++steps_.virtual_starts;
                find_slot(event.result, number - 1);  // what it is made of is still read
                Event copy = event;
                copy.input = event.base;
                copy.result = kNone;
                put(step(ExchangeStep::Kind::kCopy, copy, place(event.result)));
                put(step(ExchangeStep::Kind::kMerge, event, place(event.result)));
        }
    }

    ExchangeStep step(ExchangeStep::Kind kind, const Event& event, int to) {
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

    void put(const ExchangeStep& made) { steps_.before[made.task].push_back(made); }

    /// At once, by the device that made it: later it has gone on.
    void keep(Id id, int task, int number) {
        find_slot(id, number);
        const Value& value = cell_.value(id);
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
    void find_slot(Id id, int number) {
        Value& value = cell_.value(id);
        const auto is_over = [&](const Value& last) { return last.last_use <= number; };
        for (const bool at_leisure : {true, false}) {
            for (std::size_t s = 0; s < holds_.size(); ++s) {
                const Value& last = cell_.value(holds_[s]);
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

    const ExchangeProblem& problem_;
    CellExchange& cell_;
    CellSteps steps_;
    std::vector<Id> holds_;  ///< [slot]
};

/// Steps of cells side by side that are the same become one.
class Joined {
public:
    void add(const StepsByTask& steps, int task, int cell) {
        const auto found = steps.find(task);
        if (found == steps.end()) return;
        if (rows_.empty() || end_ != cell || rows_.back() != found->second) {
            rows_.push_back(found->second);
            begins_.push_back(cell);
            ends_.push_back(cell);
        }
        end_ = ends_.back() = cell + 1;
    }
    void append_to(std::vector<ExchangeStep>& list) const {
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            for (ExchangeStep step : rows_[r]) {
                step.cells = {begins_[r], ends_[r]};
                list.push_back(step);
            }
        }
    }

private:
    std::vector<std::vector<ExchangeStep>> rows_;
    std::vector<int> begins_, ends_;
    int end_ = -1;
};

std::vector<int> order_of_starts(const ExchangeProblem& problem) {
    std::vector<int> order(problem.tasks.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(
        order, {}, [&](int t) { return problem.tasks[static_cast<std::size_t>(t)].start; });
    return order;
}

bool covers(const std::vector<CellRange>& ranges, int cell) {
    return std::ranges::any_of(ranges,
                               [&](const CellRange& r) { return r.begin <= cell && cell < r.end; });
}

void check_times(const ExchangeProblem& problem, const std::vector<std::vector<int>>& needed) {
    for (std::size_t t = 0; t < needed.size(); ++t) {
        for (const int u : needed[t]) {
            const double end = problem.tasks[static_cast<std::size_t>(u)].end;
            if (problem.tasks[t].start >= end) continue;
            throw std::logic_error("exchange map: task " + std::to_string(t) +
                                   " starts before task " + std::to_string(u) +
                                   ", which it needs, has ended");
        }
    }
}

}  // namespace

ExchangeMap make_exchange_map(const ExchangeProblem& problem) {
    const auto needed = needed_tasks(problem);
    check_times(problem, needed);
    const std::vector<int> order = order_of_starts(problem);
    double end = 0.0;
    for (const ExchangeTask& task : problem.tasks) end = std::max(end, task.end);

    std::vector<CellSteps> cells;
    ExchangeMap map;
    for (int c = 0; c < static_cast<int>(problem.owners.size()); ++c) {
        CellExchange cell(problem, needed, c);
        for (const int t : order) {
            const ExchangeTask& task = problem.tasks[static_cast<std::size_t>(t)];
            if (covers(task.reads, c)) cell.run(t, covers(task.writes, c));
        }
        cell.end(end);
        const CellSteps& steps = cells.emplace_back(CellPlaces(problem, cell).steps(order.front()));
        map.slots = std::max(map.slots, steps.slots);
        map.virtual_starts += steps.virtual_starts;
    }
    const auto add = [&](int task, bool behind) {
        Joined joined;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            joined.add(behind ? cells[c].behind : cells[c].before, task, static_cast<int>(c));
        }
        joined.append_to(map.steps);
    };
    for (const int t : order) {
        add(t, false);
        ExchangeStep step;
        step.task = t;
        step.device = problem.tasks[static_cast<std::size_t>(t)].device;
        map.steps.push_back(step);
        add(t, true);
    }
    add(static_cast<int>(problem.tasks.size()), false);
    return map;
}

}  // namespace weft::scheduler
