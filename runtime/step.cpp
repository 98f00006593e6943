#include "runtime/step.h"

#include <algorithm>
#include <map>
#include <string>

#include "runtime/error.h"
#include "scheduler/assert.h"

namespace weft {

namespace {

/// Tables are known by where they lie; null stands for a buffer's elements.
bool same_table(const Segments* a, const Segments* b) {
    if (a == nullptr || b == nullptr) return a == b;
    return a->begin == b->begin && a->first == b->first;
}

bool same_units(const Access& a, const Access& b) {
    return a.buffer == b.buffer && same_table(a.segments, b.segments);
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

/// Accesses in different units cannot be compared: so a buffer has one, or tables of it that share
/// no item.
void refuse_mixed_units(const std::vector<Task>& tasks) {
    std::map<const BufferStorage*, std::vector<const Segments*>> tables;
    for (const Task& task : tasks) {
        for (const Access& access : task.accesses) {
            auto& known = tables[access.buffer];
            const auto is_same = [&](const Segments* t) { return same_table(t, access.segments); };
            if (std::ranges::any_of(known, is_same)) continue;
            for (const Segments* other : known) {
                if (!apart(other, access.segments))
                    refuse(task, access, "in units of another kind");
            }
            known.push_back(access.segments);
        }
    }
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
double conflict(const Task& first, const Task& second) {
    double bytes = -1.0;
    for (const Access& a : first.accesses) {
        for (const Access& b : second.accesses) {
            if (!(a.writes || b.writes) || !same_units(a, b)) continue;
            const int common = overlap(a, b);
            if (common == 0) continue;
            bytes = std::max(bytes, 0.0);
            if (a.writes)
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
    refuse_mixed_units(tasks_);
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
            const double bytes = conflict(tasks_[static_cast<std::size_t>(from % count)],
                                          tasks_[static_cast<std::size_t>(to % count)]);
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
