#include "runtime/memory_map.h"

#include <algorithm>

#include "scheduler/assert.h"

namespace weft {

bool MemoryMap::is_held(const Part& part, MemoryId memory) {
    return std::ranges::find(part.holders, memory, &Holder::memory) != part.holders.end();
}

bool MemoryMap::are_disjoint_and_ascending(const std::vector<Part>& parts) {
    int end = 0;
    return std::ranges::all_of(parts, [&](const Part& part) {
        const bool follows = end <= part.interval.begin && part.interval.begin < part.interval.end;
        end = part.interval.end;
        return follows;
    });
}

MemoryMap::Key MemoryMap::key_of(const Access& access) {
    return {access.buffer, access.segments == nullptr ? -1 : access.segments->first};
}

void MemoryMap::cut(std::vector<Part>& parts, Interval interval) {
    for (const int at : {interval.begin, interval.end}) {
        const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
            return p.interval.begin < at && at < p.interval.end;
        });
        if (part == parts.end()) continue;
        Part upper = *part;
        upper.interval.begin = at;
        part->interval.end = at;
        parts.insert(part + 1, std::move(upper));
    }
}

std::vector<MemoryMap::Missing> MemoryMap::missing(const Access& access, MemoryId memory) const {
    std::vector<Missing> result;
    const auto entry = entries_.find(key_of(access));
    if (entry == entries_.end()) return result;
    for (const Part& part : entry->second.parts) {
        const Interval common{std::max(part.interval.begin, access.begin),
                              std::min(part.interval.end, access.end)};
        if (common.begin >= common.end) continue;
        if (is_held(part, memory)) continue;
        WEFT_ASSERT(!part.holders.empty());
        // The host first: it is one copy away, other devices are two.
        const auto source =
            std::min_element(part.holders.begin(), part.holders.end(),
                             [](const Holder& a, const Holder& b) { return a.memory < b.memory; });
        add(result, common, *source);
    }
    return result;
}

/// Longer than the last stretch, or a new one.
void MemoryMap::add(std::vector<Missing>& list, Interval interval, const Holder& source) {
    const bool goes_on = !list.empty() && list.back().source == source.memory &&
                         list.back().interval.end == interval.begin;
    if (!goes_on) list.push_back({{interval.begin, interval.begin}, source.memory, {}});
    Missing& stretch = list.back();
    stretch.interval.end = interval.end;
    if (source.since == nullptr || std::ranges::count(stretch.made_by, source.since) > 0) return;
    stretch.made_by.push_back(source.since);
}

std::vector<Completion*> MemoryMap::arrivals(const Access& access, MemoryId memory) const {
    std::vector<Completion*> result;
    const auto entry = entries_.find(key_of(access));
    if (entry == entries_.end()) return result;
    for (const Part& part : entry->second.parts) {
        if (part.interval.end <= access.begin || access.end <= part.interval.begin) continue;
        for (const Holder& holder : part.holders) {
            if (holder.memory != memory || !holder.copied || holder.since == nullptr) continue;
            if (result.empty() || result.back() != holder.since) result.push_back(holder.since);
        }
    }
    return result;
}

void MemoryMap::arrived(const Access& access, Interval interval, MemoryId memory,
                        Completion* arrival) {
    std::vector<Part>& parts = entries_[key_of(access)].parts;
    cut(parts, interval);
    for (Part& part : parts) {
        if (part.interval.begin >= interval.begin && part.interval.end <= interval.end) {
            WEFT_ASSERT(!is_held(part, memory));
            part.holders.push_back({memory, arrival, true});
        }
    }
}

void MemoryMap::written(const Access& access, MemoryId memory, Completion* task) {
    Entry& entry = entries_[key_of(access)];
    entry.segments = access.segments;
    const Interval interval{access.begin, access.end};
    cut(entry.parts, interval);
    std::erase_if(entry.parts, [&](const Part& part) {
        return part.interval.begin >= interval.begin && part.interval.end <= interval.end;
    });
    const auto behind = std::find_if(entry.parts.begin(), entry.parts.end(), [&](const Part& part) {
        return part.interval.begin >= interval.end;
    });
    entry.parts.insert(behind, {interval, {{memory, task, false}}});
    WEFT_ASSERT(are_disjoint_and_ascending(entry.parts));
}

void MemoryMap::forget(const BufferStorage& buffer) {
    std::erase_if(entries_, [&](const auto& entry) { return entry.first.first == &buffer; });
}

void MemoryMap::settle() {
    for (auto& [key, entry] : entries_) {
        for (Part& part : entry.parts) {
            for (Holder& holder : part.holders) holder.since = nullptr;
        }
    }
}

std::vector<std::pair<Access, MemoryMap::Missing>> MemoryMap::missing_at_host(
    const BufferStorage& buffer) const {
    std::vector<std::pair<Access, Missing>> result;
    for (const auto& [key, entry] : entries_) {
        if (key.first != &buffer || entry.parts.empty()) continue;
        const Access all{key.first, entry.segments, entry.parts.front().interval.begin,
                         entry.parts.back().interval.end};
        for (Missing& missing : this->missing(all, MemoryId::host()))
            result.emplace_back(all, std::move(missing));
    }
    return result;
}

ElementSpan elements_of(const Access& access, Interval interval) {
    WEFT_ASSERT(interval.begin <= interval.end);
    const Segments* s = access.segments;
    return {static_cast<std::size_t>(s == nullptr ? interval.begin : s->item(interval.begin)),
            static_cast<std::size_t>(s == nullptr ? interval.end : s->item(interval.end))};
}

}  // namespace weft
