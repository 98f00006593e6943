#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "scheduler/cell_history.h"
#include "scheduler/exchange_map.h"

namespace weft::scheduler {

namespace {

/// What lies in one place of one cell.
struct Content {
    History history;
    int value = -1;
    double read_until = 0.0;  ///< somebody may be reading it until then, by plan
};

class MapCheck {
public:
    MapCheck(const ExchangeProblem& problem, const ExchangeMap& map)
        : problem_(problem),
          map_(map),
          needed_(needed_tasks(problem)),
          done_(problem.tasks.size(), false) {
        for (int c = 0; c < static_cast<int>(problem.owners.size()); ++c) contents_[{0, c}] = {};
    }

    std::string fault() {
        for (const ExchangeStep& step : map_.steps) {
            if (step.kind == ExchangeStep::Kind::kTask)
                do_task(step);
            else
                for (int c = step.cells.begin; c < step.cells.end; ++c) exchange(step, c);
            if (!fault_.empty()) return fault_;
        }
        look_at_end();
        return fault_;
    }

private:
    const ExchangeTask& task(int t) const { return problem_.tasks[static_cast<std::size_t>(t)]; }

    void report(int task, const std::string& what) {
        if (fault_.empty()) fault_ = "task " + std::to_string(task) + ": " + what;
    }

    Content* content(int place, int cell) {
        const auto found = contents_.find({place, cell});
        return found == contents_.end() ? nullptr : &found->second;
    }

    /// When it is done, by plan.
    double time_of(const ExchangeStep& step) const {
        if (step.task == static_cast<int>(problem_.tasks.size())) return end_;
        const bool is_behind = done_[static_cast<std::size_t>(step.task)];
        return is_behind ? task(step.task).end : task(step.task).start;
    }

    void do_task(const ExchangeStep& step) {
        const ExchangeTask& t = task(step.task);
        const auto number = static_cast<std::size_t>(step.task);
        if (done_[number]) report(step.task, "done twice");
        done_[number] = true;
        end_ = std::max(end_, t.end);
        for (const CellRange& range : t.reads) {
            for (int c = range.begin; c < range.end; ++c) look(step.task, c);
        }
        for (const CellRange& range : t.writes) {
            for (int c = range.begin; c < range.end; ++c) {
                Content* own = content(t.device, c);
                if (own == nullptr) return report(step.task, "writes what is not there");
                own->history.add(step.task);
                own->value = 2 * step.task + 1;
            }
        }
    }

    /// What a task reads must contain what it needs, and nothing from the future.
    void look(int number, int cell) {
        const ExchangeTask& t = task(number);
        const Content* own = content(t.device, cell);
        if (own == nullptr) return report(number, "reads what is not there");
        const auto& needed = needed_[static_cast<std::size_t>(number)];
        for (int u = 0; u < static_cast<int>(problem_.tasks.size()); ++u) {
            const bool has = own->history.contains(u);
            const bool needs = std::ranges::find(needed, u) != needed.end();
            if (needs && !has && writes(u, cell)) {
                return report(number, "has not seen task " + std::to_string(u));
            }
            if (needs || task(u).device == t.device || t.synchronous) continue;
            const bool was_there = task(u).end + problem_.wait <= t.start * (1.0 + 1e-12);
            if (!has && was_there && writes(u, cell)) {
                return report(number, "has not been given task " + std::to_string(u));
            }
            if (has && !was_there && !comes_along(number, u)) {
                return report(number, "has seen task " + std::to_string(u) + " too early");
            }
        }
    }

    /// With what is needed.
    bool comes_along(int number, int u) const {
        const auto& needed = needed_[static_cast<std::size_t>(number)];
        return std::ranges::any_of(needed, [&](int v) { return task(v).end >= task(u).end; });
    }

    bool writes(int number, int cell) const {
        return std::ranges::any_of(task(number).writes, [&](const CellRange& r) {
            return r.begin <= cell && cell < r.end;
        });
    }

    void exchange(const ExchangeStep& step, int cell) {
        Content* from = content(step.from, cell);
        if (from == nullptr || from->value != step.from_value) {
            return report(step.task, "an input is not what it should be");
        }
        const double time = time_of(step);
        from->read_until = std::max(from->read_until, time);
        Content result = *from;
        if (step.kind == ExchangeStep::Kind::kMerge) {
            Content* to = content(step.to, cell);
            Content* start = content(step.start, cell);
            if (to == nullptr || start == nullptr || start->value != step.start_value) {
                return report(step.task, "a start point is not what it should be");
            }
            if (!(start->history == both(to->history, from->history))) {
                return report(step.task, "a start point is not what both started from");
            }
            start->read_until = std::max(start->read_until, time);
            result.history.unite(to->history);
        } else {
            look_at_copy(step, cell, *from, time);
        }
        result.value = step.to_value;
        result.read_until = 0.0;
        contents_[{step.to, cell}] = result;
    }

    void look_at_copy(const ExchangeStep& step, int cell, const Content& from, double time) {
        const Content* old = content(step.to, cell);
        if (old == nullptr) return;
        if (step.to >= problem_.devices) {
            if (old->read_until > time) report(step.task, "a slot is reused too early");
            return;
        }
        if (old->history.within(from.history)) return;
        const bool is_owner = problem_.owners[static_cast<std::size_t>(cell)] == step.to;
        const bool is_end = step.task == static_cast<int>(problem_.tasks.size());
        if (is_owner && !is_end) report(step.task, "an owner's cell is copied over");
    }

    void look_at_end() {
        for (int c = 0; c < static_cast<int>(problem_.owners.size()); ++c) {
            for (int t = 0; t < static_cast<int>(problem_.tasks.size()); ++t) {
                if (!done_[static_cast<std::size_t>(t)]) return report(t, "never done");
                if (writes(t, c) && !content(0, c)->history.contains(t)) {
                    return report(t, "lost in the end");
                }
            }
        }
    }

    const ExchangeProblem& problem_;
    const ExchangeMap& map_;
    std::vector<std::vector<int>> needed_;
    std::vector<bool> done_;
    std::map<std::pair<int, int>, Content> contents_;  ///< [place, cell]
    double end_ = 0.0;
    std::string fault_;
};

}  // namespace

std::string find_fault(const ExchangeProblem& problem, const ExchangeMap& map) {
    return MapCheck(problem, map).fault();
}

}  // namespace weft::scheduler
