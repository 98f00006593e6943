#include "simulation/contact/body_groups.h"

#include <algorithm>
#include <bit>

#include "kernels/contact/codes.h"
#include "simulation/contact/interval_box.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Which coordinate of a box differs most.
double Vec3::*longest_side(const IntervalBox& box) {
    const Vec3 size = box.high - box.low;
    if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
    return size.y >= size.z ? &Vec3::y : &Vec3::z;
}

int levels_of(std::size_t bodies) {
    return std::clamp(static_cast<int>(std::bit_width(bodies)) - 2, 2, WEFT_MOST_GROUP_LEVELS);
}

}  // namespace

BodyGroups::BodyGroups(int substeps, std::vector<std::vector<int>> parts)
    : parts_(std::move(parts)),
      level_count_(levels_of(parts_.size())),
      firsts("groups.firsts", at(substeps) * at(level_count_) * parts_.size()),
      counts("groups.counts", firsts.count()),
      members("groups.members", firsts.count()),
      leaders("groups.leaders", firsts.count()) {}

void BodyGroups::place(int substep, std::vector<int> groups, const std::vector<Vec3>& centres) {
    Lists lists = listed(std::move(groups));
    for (int level = 0; level < level_count_; ++level) {
        if (level > 0) lists = halved(lists, centres);
        write(level_count_ * substep + level, lists);
    }
}

BodyGroups::Lists BodyGroups::listed(std::vector<int> groups) const {
    for (const std::vector<int>& parts : parts_) {
        for (const int part : parts) {
            const int other = groups[at(part)];
            const int own = groups[at(parts.front())];
            std::ranges::replace(groups, other, own);
        }
    }
    Lists lists(groups.size());
    for (std::size_t b = 0; b < parts_.size(); ++b) {
        lists[at(groups[at(parts_[b].front())])].push_back(static_cast<int>(b));
    }
    return lists;
}

BodyGroups::Lists BodyGroups::halved(const Lists& groups, const std::vector<Vec3>& centres) const {
    Lists halves;
    for (std::vector<int> group : groups) {
        if (group.empty()) continue;
        const auto centre = [&](int body) { return centres[at(parts_[at(body)].front())]; };
        IntervalBox box;
        for (const int body : group) box.include(centre(body));
        const auto side = longest_side(box);
        std::ranges::stable_sort(group, {}, [&](int body) { return centre(body).*side; });
        const auto middle = group.begin() + static_cast<std::ptrdiff_t>(group.size() / 2);
        halves.emplace_back(group.begin(), middle);
        halves.emplace_back(middle, group.end());
        for (const auto half : {halves.end() - 2, halves.end() - 1}) std::ranges::sort(*half);
    }
    return halves;
}

void BodyGroups::write(int table, const Lists& groups) {
    const std::size_t begin = at(table) * parts_.size();
    std::fill_n(counts.data() + begin, parts_.size(), 0);
    std::size_t next = 0;
    for (const std::vector<int>& group : groups) {
        if (group.empty()) continue;
        firsts[begin + at(group.front())] = static_cast<int>(next);
        counts[begin + at(group.front())] = static_cast<int>(group.size());
        for (const int body : group) {
            members[begin + next++] = body;
            leaders[begin + at(body)] = group.front();
        }
    }
}

}  // namespace weft
