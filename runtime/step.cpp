#include "runtime/step.h"

#include <algorithm>

namespace weft {

namespace {

bool same_units(const Access& a, const Access& b) {
    if (a.buffer != b.buffer) return false;
    const auto key = [](const Access& access) {
        return access.segments == nullptr ? -1 : access.segments->first;
    };
    return key(a) == key(b);
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
    if (access.begin < access.end) {
        step_.tasks_[static_cast<std::size_t>(task_)].accesses.push_back(access);
    }
    return *this;
}

Step::Adding& Step::Adding::reads(BufferStorage& buffer, int begin, int end) {
    return access({&buffer, nullptr, begin, end, false});
}

Step::Adding& Step::Adding::updates(BufferStorage& buffer, int begin, int end) {
    return access({&buffer, nullptr, begin, end, true});
}

Step::Adding& Step::Adding::updates(BufferStorage& buffer, const Segments& strips) {
    const Task& task = step_.tasks_[static_cast<std::size_t>(task_)];
    return access({&buffer, &strips, task.first_strip, task.end_strip, true});
}

Step::Adding Step::add(const TaskBody& body, int iteration, int first_strip, int end_strip,
                       int region) {
    tasks_.push_back({&body,
                      iteration,
                      first_strip,
                      end_strip,
                      region,
                      body.item_count(first_strip, end_strip),
                      {}});
    return {*this, static_cast<int>(tasks_.size()) - 1};
}

void Step::seal() {
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
