#pragma once

#include <numeric>
#include <span>
#include <vector>

namespace weft {

/// A list of values for each of some groups, all in one piece of memory.
template <class T>
class Grouped {
public:
    Grouped() : begin_{0} {}
    /// for_each(put): calls put(group, value) for all there are; the same ones each time. Values of
    /// a group stay in their order.
    template <class ForEach>
    Grouped(int groups, const ForEach& for_each) : begin_(at(groups) + 1, 0) {
        for_each([&](int group, const T&) { ++begin_[at(group) + 1]; });
        put_all(for_each);
    }
    /// So many values of each group, to be filled in: size_of(group).
    template <class SizeOf>
    static Grouped of_sizes(int groups, const SizeOf& size_of) {
        Grouped grouped;
        grouped.begin_.resize(at(groups) + 1, 0);
        for (int group = 0; group < groups; ++group) {
            grouped.begin_[at(group) + 1] = grouped.begin_[at(group)] + size_of(group);
        }
        grouped.values_.resize(grouped.begin_.back());
        return grouped;
    }

    int count() const { return static_cast<int>(begin_.size()) - 1; }
    std::span<T> operator[](int group) {
        return {values_.data() + begin_[at(group)], values_.data() + begin_[at(group) + 1]};
    }
    std::span<const T> operator[](int group) const {
        return {values_.data() + begin_[at(group)], values_.data() + begin_[at(group) + 1]};
    }
    /// Group by group.
    std::span<const T> values() const { return values_; }

private:
    /// begin_ has the sizes of the groups before.
    template <class ForEach>
    void put_all(const ForEach& for_each) {
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        values_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        for_each([&](int group, const T& value) { values_[next[at(group)]++] = value; });
    }
    static std::size_t at(int group) { return static_cast<std::size_t>(group); }

    std::vector<std::size_t> begin_;  ///< [groups + 1]
    std::vector<T> values_;
};

}  // namespace weft
