#include "scheduler/cell_exchange.h"

#include <algorithm>
#include <stdexcept>

namespace weft::scheduler {

CellExchange::CellExchange(const ExchangeProblem& problem,
                           const std::vector<std::vector<int>>& needed, int cell)
    : problem_(problem),
      needed_(needed),
      owner_(problem.owners[static_cast<std::size_t>(cell)]),
      current_(static_cast<std::size_t>(problem.devices), kNoValue),
      made_by_(current_.size()) {
    values_.push_back({});
    current_[0] = kFirstValue;
}

ValueId CellExchange::add(const CellValue& made) {
    values_.push_back(made);
    return static_cast<ValueId>(values_.size()) - 1;
}

void CellExchange::run(int task, bool writes) {
    const ExchangeTask& t = problem_.tasks[static_cast<std::size_t>(task)];
    task_ = task;
    start_ = t.start;
    synchronous_ = t.synchronous;
    prepare(t.device);
    if (!writes) return;
    CellValue made = value(current(t.device));
    made = {made.history, t.device, 2 * task + 1, t.end};
    made.history.add(task);
    const ValueId id = add(made);
    current(t.device) = id;
    made_by_[static_cast<std::size_t>(t.device)].push_back(id);
    events_.push_back({CellEvent::Kind::kMade, task, t.device, t.device, id});
}

/// Place 0 gets the owner's, which gets all.
void CellExchange::end(double time) {
    task_ = static_cast<int>(problem_.tasks.size());
    start_ = time;
    synchronous_ = true;
    if (std::ranges::all_of(made_by_, [](const auto& list) { return list.empty(); })) return;
    prepare(owner_);
    if (owner_ != 0 && current_[0] != current(owner_)) {
        events_.push_back({CellEvent::Kind::kTake, task_, owner_, 0, kNoValue, kNoValue,
                           current(owner_), kNoValue, owner_});
    }
}

bool CellExchange::contains_all_of(int device, ValueId id) {
    return current(device) != kNoValue && history(id).within(history(current(device)));
}

void CellExchange::prepare(int device) {
    if (current(device) == kNoValue) take(device, oldest_for(device));
    std::vector<int> others;
    if (owner_ != device) others.push_back(owner_);
    for (int q = 0; q < problem_.devices; ++q) {
        if (q != device && q != owner_) others.push_back(q);
    }
    for (const int q : others) {
        for (const ValueId id : inputs_from(q, device)) bring(device, q, id);
    }
}

/// The first that a device gets. What another one, that it needs, has made of it is better.
ValueId CellExchange::oldest_for(int device) {
    for (const int q : {owner_, 0}) {
        if (q == device) continue;
        const auto inputs = inputs_from(q, device);
        if (!inputs.empty()) return inputs.back();
    }
    return kFirstValue;
}

/// What there is of another device, and what there must be: of that, all that no other
/// contains.
std::vector<ValueId> CellExchange::inputs_from(int q, int device) {
    const auto& made = made_by_[static_cast<std::size_t>(q)];
    std::vector<ValueId> list;
    for (const ValueId id : made) {
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

std::vector<ValueId> CellExchange::largest_of(const std::vector<ValueId>& list) {
    std::vector<ValueId> largest;
    for (const ValueId id : list) {
        const auto is_in = [&](ValueId other) {
            return other > id && history(id).within(history(other));
        };
        if (std::ranges::none_of(list, is_in)) largest.push_back(id);
    }
    return largest;
}

std::vector<int> CellExchange::needed_now() const {
    if (task_ == static_cast<int>(needed_.size())) return {};
    return needed_[static_cast<std::size_t>(task_)];
}

void CellExchange::add_needed(int u, const std::vector<ValueId>& made, int device,
                              std::vector<ValueId>& list) {
    const auto has = [&](ValueId id) { return history(id).contains(u); };
    if (std::ranges::any_of(list, has)) return;
    if (current(device) != kNoValue && has(current(device))) return;
    const auto first = std::ranges::find_if(made, has);
    if (first != made.end()) list.push_back(*first);
}

void CellExchange::bring(int device, int from, ValueId input) {
    if (contains_all_of(device, input)) return;
    const bool drops = problem_.dropping && !synchronous_ && from == owner_;
    if (drops || history(current(device)).within(history(input))) return take(device, input);
    merge(device, input, start_for(device, from, input));
}

/// What both contain; mostly there was a time when the input's device was just there. Where it
/// was not, having had two exchanges crosswise, its tasks are taken one by one: before each of
/// them it was.
ValueId CellExchange::start_for(int device, int from, ValueId input) {
    ValueId start = existing(both(history(current(device)), history(input)));
    if (start != kNoValue) return start;
    const std::vector<ValueId> made = made_by_[static_cast<std::size_t>(from)];
    for (const ValueId id : made) {
        if (id < input && !contains_all_of(device, id)) bring(device, from, id);
    }
    return find(both(history(current(device)), history(input)), device);
}

void CellExchange::take(int device, ValueId input) {
    CellEvent event{CellEvent::Kind::kTake, task_, device, device, kNoValue, kNoValue, input};
    event.direct_from = place_with(input);
    if (event.direct_from < 0) use(input);
    events_.push_back(event);
    current(device) = input;
}

void CellExchange::merge(int device, ValueId input, ValueId start) {
    CellEvent event{CellEvent::Kind::kMerge, task_, device, device, kNoValue,
                    current(device),         input, start};
    event.direct_from = place_with(input);
    if (event.direct_from < 0) use(input);
    use(start);
    const History all = either(history(current(device)), history(input));
    event.result = add({all, device, 2 * task_, start_});
    events_.push_back(event);
    current(device) = event.result;
}

/// Only synchronous tasks read from another's iterate, which has to wait for them.
int CellExchange::place_with(ValueId id) {
    if (!synchronous_) return -1;
    const int device = value(id).device;
    return current(device) == id ? device : -1;
}

void CellExchange::use(ValueId id) {
    CellValue& used = value(id);
    used.is_kept = true;
    used.last_use = static_cast<int>(events_.size());
    used.last_time = start_;
}

ValueId CellExchange::existing(const History& wanted) {
    for (ValueId id = static_cast<ValueId>(values_.size()) - 1; id >= 0; --id) {
        if (history(id) == wanted) return id;
    }
    return kNoValue;
}

/// The value that contains just these tasks; made where there never was one.
ValueId CellExchange::find(const History& wanted, int device) {
    if (const ValueId id = existing(wanted); id != kNoValue) return id;
    ValueId have = largest_within(wanted, {});
    while (!(history(have) == wanted)) {
        const ValueId more = largest_within(wanted, history(have));
        have = join(have, more, device);
    }
    return have;
}

/// By what it has more than another one.
ValueId CellExchange::largest_within(const History& wanted, const History& known) {
    ValueId best = kFirstValue;
    int most = 0;
    for (ValueId id = 0; id < static_cast<ValueId>(values_.size()); ++id) {
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

ValueId CellExchange::join(ValueId a, ValueId b, int device) {
    if (history(a).within(history(b))) return b;
    const ValueId start = find(both(history(a), history(b)), device);
    for (const ValueId id : {a, b, start}) use(id);
    CellValue made{either(history(a), history(b)), device, 2 * task_, start_};
    made.is_kept = true;
    const ValueId id = add(made);
    events_.push_back({CellEvent::Kind::kVirtual, task_, device, device, id, a, b, start});
    return id;
}

}  // namespace weft::scheduler
