#include "simulation/contact/body_groups.h"

#include <algorithm>

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

BodyGroups::BodyGroups(int substeps, std::vector<std::vector<int>> parts)
    : parts_(std::move(parts)),
      firsts("groups.firsts", at(substeps) * parts_.size()),
      counts("groups.counts", firsts.count()),
      members("groups.members", firsts.count()),
      leaders("groups.leaders", firsts.count()) {}

void BodyGroups::place(int substep, std::vector<int> groups) {
    for (const std::vector<int>& parts : parts_) {
        for (const int part : parts) {
            const int other = groups[at(part)];
            const int own = groups[at(parts.front())];
            std::ranges::replace(groups, other, own);
        }
    }
    std::vector<std::vector<int>> lists(groups.size());
    for (std::size_t b = 0; b < parts_.size(); ++b) {
        lists[at(groups[at(parts_[b].front())])].push_back(static_cast<int>(b));
    }
    const std::size_t begin = at(substep) * parts_.size();
    std::fill_n(counts.data() + begin, parts_.size(), 0);
    std::size_t next = 0;
    for (const std::vector<int>& list : lists) {
        if (list.empty()) continue;
        firsts[begin + at(list.front())] = static_cast<int>(next);
        counts[begin + at(list.front())] = static_cast<int>(list.size());
        for (const int body : list) {
            members[begin + next++] = body;
            leaders[begin + at(body)] = list.front();
        }
    }
}

}  // namespace weft
