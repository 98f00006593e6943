#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace weft::scheduler {

/// Which tasks a value of a cell contains.
class History {
public:
    void add(int task) {
        const auto word = static_cast<std::size_t>(task) / 64;
        if (word >= words_.size()) words_.resize(word + 1, 0);
        words_[word] |= std::uint64_t{1} << (task % 64);
    }
    bool contains(int task) const {
        const auto word = static_cast<std::size_t>(task) / 64;
        return word < words_.size() && (words_[word] >> (task % 64) & 1) != 0;
    }
    bool within(const History& other) const {
        for (std::size_t w = 0; w < words_.size(); ++w) {
            if ((words_[w] & ~other.word(w)) != 0) return false;
        }
        return true;
    }
    int count() const {
        int bits = 0;
        for (const std::uint64_t word : words_) bits += std::popcount(word);
        return bits;
    }
    void unite(const History& other) {
        if (words_.size() < other.words_.size()) words_.resize(other.words_.size(), 0);
        for (std::size_t w = 0; w < words_.size(); ++w) words_[w] |= other.word(w);
    }
    void intersect(const History& other) {
        for (std::size_t w = 0; w < words_.size(); ++w) words_[w] &= other.word(w);
    }
    friend bool operator==(const History& a, const History& b) {
        return a.within(b) && b.within(a);
    }

private:
    std::uint64_t word(std::size_t w) const { return w < words_.size() ? words_[w] : 0; }

    std::vector<std::uint64_t> words_;
};

inline History both(History a, const History& b) {
    a.intersect(b);
    return a;
}

inline History either(History a, const History& b) {
    a.unite(b);
    return a;
}

}  // namespace weft::scheduler
