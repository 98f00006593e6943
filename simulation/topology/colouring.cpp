#include "simulation/topology/colouring.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "scheduler/assert.h"

namespace weft {
namespace {

constexpr int kWordBits = 64;

/// place[c]: where colour c comes in the given round. Falling colours and random orders in turn:
/// the first empties the highest colours, the second finds the way out where that is stuck.
std::vector<int> shuffled_places(int count, int round) {
    std::vector<int> place(static_cast<std::size_t>(count));
    for (int c = 0; c < count; ++c) place[c] = count - 1 - c;
    if (round % 2 == 0) return place;
    auto state = static_cast<std::uint32_t>(round);  // not std::shuffle: its result is unspecified
    for (int c = count - 1; c > 0; --c) {
        state = state * 1664525u + 1013904223u;
        std::swap(place[c], place[(state >> 16) % static_cast<std::uint32_t>(c + 1)]);
    }
    return place;
}

}  // namespace

Colourer::Colourer(const Stencils& kind, int vertex_count)
    : kind_(kind), taken_(static_cast<std::size_t>(vertex_count), 0) {}

std::uint64_t Colourer::taken(int element) const {
    std::uint64_t result = 0;
    for (int v : kind_[element]) result |= taken_[v];
    return result;
}

void Colourer::toggle(int element, int bit) {
    for (int v : kind_[element]) taken_[v] ^= std::uint64_t{1} << bit;
}

void Colourer::forget(std::span<const int> elements) {
    for (int e : elements) {
        for (int v : kind_[e]) taken_[v] = 0;
    }
}

int Colourer::lower_bound(std::span<const int> elements) {
    std::uint64_t most = 0;
    for (int e : elements) {
        for (int v : kind_[e]) most = std::max(most, ++taken_[v]);
    }
    forget(elements);
    return static_cast<int>(most);
}

int Colourer::colour_group(std::span<const int> elements, int goal, std::span<int> colour) {
    int count = first_fit(elements, colour);
    // Only a vertex with very many elements takes more than a word of colours, and needs them all.
    if (count > kWordBits) return count;
    if (count > goal) count = improve(elements, count, goal, colour);
    balance(elements, count, colour);
    return count;
}

/// Gives each element the lowest colour that its vertices have not met. Works through 64 colours at
/// a time: elements that find none wait for the next 64.
int Colourer::first_fit(std::span<const int> elements, std::span<int> colour) {
    int count = 0;
    std::vector<int> waiting;
    for (int base = 0; !elements.empty(); base += kWordBits) {
        std::vector<int> left;
        for (int e : elements) {
            const int bit = std::countr_one(taken(e));
            if (bit == kWordBits) {
                left.push_back(e);
                continue;
            }
            toggle(e, bit);
            colour[e] = base + bit;
            count = std::max(count, base + bit + 1);
        }
        forget(elements);
        waiting.swap(left);
        elements = waiting;
    }
    return count;
}

/// Stable counting sort of sequence_ by place[colour].
void Colourer::sort_by_colour(std::span<const int> place, std::span<const int> colour) {
    std::vector<int> next(place.size() + 1, 0);
    for (int e : sequence_) ++next[place[colour[e]] + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    scratch_.resize(sequence_.size());
    for (int e : sequence_) scratch_[next[place[colour[e]]]++] = e;
    sequence_.swap(scratch_);
}

/// Iterated greedy (Culberson 1992): first fit in any order that keeps each colour together never
/// needs more colours than before, and often fewer.
int Colourer::improve(std::span<const int> elements, int count, int goal, std::span<int> colour) {
    constexpr int kRounds = 32;  // with 128, one mesh in ten saves one more colour
    sequence_.assign(elements.begin(), elements.end());
    for (int round = 0; round < kRounds && count > goal; ++round) {
        sort_by_colour(shuffled_places(count, round), colour);
        count = first_fit(sequence_, colour);
    }
    return count;
}

/// Moves elements out of large colours into the smallest ones that their vertices allow, so that
/// every launch is well filled.
void Colourer::balance(std::span<const int> elements, int count, std::span<int> colour) {
    std::vector<int> size(static_cast<std::size_t>(count), 0);
    for (int e : elements) {
        ++size[colour[e]];
        toggle(e, colour[e]);
    }
    for (int e : elements) {
        const std::uint64_t here = taken(e);
        WEFT_ASSERT((here >> colour[e] & 1) != 0);  // its own
        int best = colour[e];
        int best_size = size[best] - 1;
        for (int c = 0; c < count; ++c) {
            if ((here >> c & 1) != 0 || size[c] >= best_size) continue;
            best = c;
            best_size = size[c];
        }
        if (best == colour[e]) continue;
        toggle(e, colour[e]);
        toggle(e, best);
        --size[colour[e]];
        ++size[best];
        colour[e] = best;
    }
    forget(elements);
}

}  // namespace weft
