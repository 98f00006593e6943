#include "runtime/step.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "runtime/error.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

/// Tables are known by where they lie; null stands for a buffer's elements.
bool same_table(const Segments* a, const Segments* b) {
    if (a == nullptr || b == nullptr) return a == b;
    return a->begin == b->begin && a->first == b->first;
}

/// Whether no item of one table is an item of the other.
bool apart(const Segments* a, const Segments* b) {
    if (a == nullptr || b == nullptr || a->begin != b->begin) return false;
    return a->item(a->strip_count) <= b->item(0) || b->item(b->strip_count) <= a->item(0);
}

[[noreturn]] void refuse(const Task& task, const Access& access, const std::string& why) {
    throw Misuse("task '" + task.body->name + "', buffer '" + access.buffer->name() +
                 "', access [" + std::to_string(access.begin) + ", " + std::to_string(access.end) +
                 "): " + why);
}

/// Numbers what accesses are in units of: a buffer's elements, or the strips of a table of it.
/// Accesses in different units cannot be compared, so a buffer has one, or tables that share no
/// item.
class Units {
public:
    int number_of(const Task& task, const Access& access) {
        auto& known = tables_[access.buffer];
        for (const auto& [table, number] : known) {
            if (same_table(table, access.segments)) return number;
        }
        for (const auto& [table, number] : known) {
            if (!apart(table, access.segments)) refuse(task, access, "in units of another kind");
        }
        return known.emplace_back(access.segments, count_++).second;
    }

private:
    std::unordered_map<const BufferStorage*, std::vector<std::pair<const Segments*, int>>> tables_;
    int count_ = 0;
};

struct NumberedAccess {
    int unit;
    const Access* access;
};

/// [tasks] the accesses of each by ascending units, so that two of them are compared in one go: a
/// step has thousands of pairs of tasks, and a task dozens of accesses.
std::vector<std::vector<NumberedAccess>> sorted_accesses(const std::vector<Task>& tasks) {
    Units units;
    std::vector<std::vector<NumberedAccess>> sorted;
    for (const Task& task : tasks) {
        auto& own = sorted.emplace_back();
        for (const Access& access : task.accesses) {
            own.push_back({units.number_of(task, access), &access});
        }
        std::ranges::sort(own, {}, &NumberedAccess::unit);
    }
    return sorted;
}

/// The range must lie within the buffer.
void refuse_outside(const Task& task, const Access& access) {
    const Segments* s = access.segments;
    const auto size = static_cast<int>(access.buffer->count());
    if (access.begin < 0 || access.end > (s == nullptr ? size : s->strip_count)) {
        refuse(task, access, "there is no such part");
    }
    if (s != nullptr && s->item(access.end) > size) refuse(task, access, "items beyond its end");
}

/// Launches that take turns go colour by colour through the same strips.
bool takes_turns_on_equal_terms(const TaskBody& body) {
    const auto turns = static_cast<std::size_t>(body.taking_turns);
    if (turns > body.launches.size()) return false;
    return std::ranges::all_of(body.launches.begin(), body.launches.begin() + body.taking_turns,
                               [&](const Launch& launch) {
                                   const Segments& first = body.launches[0].segments;
                                   return launch.segments.colour_count == first.colour_count &&
                                          launch.segments.strip_count == first.strip_count;
                               });
}

[[noreturn]] void refuse(const TaskBody& body, const std::string& why) {
    throw Misuse("a task of body '" + body.name + "': " + why);
}

void refuse_impossible(const TaskBody& body, int iteration, StripRange strips, RegionId region) {
    if (iteration < 0 || region < RegionId{})
        refuse(body, "iteration and region must be 0 or more");
    for (const Launch& launch : body.launches) {
        if (launch.segments.begin == nullptr) refuse(body, "a launch has no table of strips");
        if (0 <= strips.begin && !strips.empty() && strips.end <= launch.segments.strip_count) {
            continue;
        }
        refuse(body, "strips [" + std::to_string(strips.begin) + ", " + std::to_string(strips.end) +
                         "), and kernel '" + std::string(launch.kernel->name) + "' has [0, " +
                         std::to_string(launch.segments.strip_count) + ")");
    }
    if (!takes_turns_on_equal_terms(body)) {
        refuse(body, "launches that take turns need the same strips and numbers of colours");
    }
}

int overlap(const Access& a, const Access& b) {
    return std::max(0, std::min(a.end, b.end) - std::max(a.begin, b.begin));
}

/// What the second task must wait for: -1 nothing, else the bytes that it reads of the first's.
double conflict(const std::vector<NumberedAccess>& first,
                const std::vector<NumberedAccess>& second) {
    double bytes = -1.0;
    auto from = second.begin();
    for (const auto& [unit, a] : first) {
        while (from != second.end() && from->unit < unit) ++from;
        for (auto other = from; other != second.end() && other->unit == unit; ++other) {
            const Access& b = *other->access;
            const int common = a->writes || b.writes ? overlap(*a, b) : 0;
            if (common == 0) continue;
            bytes = std::max(bytes, 0.0);
            if (a->writes)
                bytes +=
                    static_cast<double>(common) * static_cast<double>(b.buffer->element_size());
        }
    }
    return bytes;
}

}  // namespace

Step::Adding& Step::Adding::access(const Access& access) {
    if (access.begin >= access.end) return *this;
    Task& task = step_.tasks_[static_cast<std::size_t>(task_)];
    refuse_outside(task, access);
    task.accesses.push_back(access);
    return *this;
}

Step::Adding& Step::Adding::reads(BufferStorage& buffer, int begin, int end) {
    return access({&buffer, nullptr, begin, end, false});
}

Step::Adding& Step::Adding::updates(BufferStorage& buffer, int begin, int end) {
    return access({&buffer, nullptr, begin, end, true});
}

Step::Adding& Step::Adding::reads(BufferStorage& buffer, const Segments& strips) {
    const Task& task = step_.tasks_[static_cast<std::size_t>(task_)];
    return access({&buffer, &strips, task.first_strip, task.end_strip, false});
}

Step::Adding& Step::Adding::reads(BufferStorage& buffer, const Segments& strips, int begin,
                                  int end) {
    return access({&buffer, &strips, begin, end, false});
}

Step::Adding& Step::Adding::reads_by_instance(BufferStorage& buffer, int elements_per_instance) {
    if (elements_per_instance < 1) {
        throw Misuse("buffer '" + buffer.name() + "': " + std::to_string(elements_per_instance) +
                     " elements per instance");
    }
    step_.add_instance_limit({&buffer, elements_per_instance});
    return reads(buffer, 0, static_cast<int>(buffer.count()));
}

Step::Adding& Step::Adding::updates(BufferStorage& buffer, const Segments& strips) {
    const Task& task = step_.tasks_[static_cast<std::size_t>(task_)];
    return access({&buffer, &strips, task.first_strip, task.end_strip, true});
}

Step::Adding Step::add(const TaskBody& body, int iteration, StripRange strips, RegionId region) {
    refuse_if_sealed();
    refuse_impossible(body, iteration, strips, region);
    tasks_.push_back({&body,
                      iteration,
                      strips.begin,
                      strips.end,
                      region,
                      body.item_count(strips.begin, strips.end),
                      {}});
    return {*this, static_cast<int>(tasks_.size()) - 1};
}

void Step::refuse_if_sealed() const {
    if (sealed_) throw Misuse("the step is sealed: tasks are added before that");
}

void Step::add(const Task& task) {
    refuse_if_sealed();
    tasks_.push_back(task);
}

void Step::seal() {
    refuse_if_sealed();
    sealed_ = true;
    const auto accesses = sorted_accesses(tasks_);
    // Two instances in a row; a dependency is kept unless it follows from others already. The
    // transitive ones are found through the set of tasks that each task is known to come after.
    const int count = static_cast<int>(tasks_.size());
    const std::size_t words = (static_cast<std::size_t>(2 * count) + 63) / 64;
    std::vector<std::uint64_t> before(static_cast<std::size_t>(2 * count) * words, 0);
    const auto row = [&](int task) {
        return before.data() + static_cast<std::size_t>(task) * words;
    };
    const auto contains = [&](int task, int earlier) {
        return (row(task)[earlier / 64] >> (earlier % 64) & 1) != 0;
    };
    for (int to = 0; to < 2 * count; ++to) {
        for (int from = to - 1; from >= std::max(0, to - count); --from) {
            if (contains(to, from)) continue;
            const double bytes = conflict(accesses[static_cast<std::size_t>(from % count)],
                                          accesses[static_cast<std::size_t>(to % count)]);
            if (bytes < 0.0) continue;
            for (std::size_t w = 0; w < words; ++w) row(to)[w] |= row(from)[w];
            row(to)[from / 64] |= std::uint64_t{1} << (from % 64);
            if (to < count)
                dependencies_.push_back({from, to, bytes});
            else if (from < count)
                carried_.push_back({from, to - count, bytes});
        }
    }
}

}  // namespace weft
