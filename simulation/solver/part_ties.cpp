#include "simulation/solver/part_ties.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Which vertices hang together.
class Parts {
public:
    explicit Parts(int vertex_count) : parents_(at(vertex_count)), sizes_(parents_.size(), 1) {
        std::iota(parents_.begin(), parents_.end(), 0);
    }

    /// A vertex of the part, the same one for all of it.
    int root(int vertex) {
        while (parents_[at(vertex)] != vertex) {
            vertex = parents_[at(vertex)] = parents_[at(parents_[at(vertex)])];
        }
        return vertex;
    }
    bool is_alone(int vertex) { return sizes_[at(root(vertex))] == 1; }
    void join(int a, int b) {
        const auto [child, parent] = std::pair(root(a), root(b));
        if (child == parent) return;
        parents_[at(child)] = parent;
        sizes_[at(parent)] += sizes_[at(child)];
    }

private:
    std::vector<int> parents_, sizes_;
};

struct Ends {
    int a, b;
    Tie tie;
};

/// All ties; everything else joins.
std::vector<Ends> find_ties(const Model& model, Parts& parts) {
    std::vector<Ends> ties;
    for (const auto& family : model.families) {
        for (int e = 0; e < family->count(); ++e) {
            const ElementCorners corners = family->corners(e);
            if (const auto tie = family->tie(e)) {
                ties.push_back({corners[0], corners[1], *tie});
                continue;
            }
            for (std::size_t k = 1; k < corners.size(); ++k) parts.join(corners[0], corners[k]);
        }
    }
    return ties;
}

/// [vertices] 1: one of the root's is held.
std::vector<char> find_held(const Model& model, Parts& parts) {
    std::vector<char> held(at(model.vertex_count()));
    for (int v = 0; v < model.vertex_count(); ++v) {
        if ((*model.positions)[at(v)].w <= 0.0f) held[at(parts.root(v))] = 1;
    }
    return held;
}

/// Numbers the roots of those that count. A vertex alone is solved exactly by itself.
std::map<int, int> number_parts(const Model& model, Parts& parts, const std::vector<Ends>& ties) {
    Parts bodies = parts;
    for (const Ends& ends : ties) bodies.join(ends.a, ends.b);
    const std::vector<char> held = find_held(model, parts);
    const std::vector<char> held_bodies = find_held(model, bodies);
    std::map<int, int> numbers;
    for (const Ends& ends : ties) {
        const auto [a, b] = std::pair(parts.root(ends.a), parts.root(ends.b));
        if (a == b) continue;
        for (const auto& [root, vertex] : {std::pair(a, ends.a), std::pair(b, ends.b)}) {
            if (held[at(root)] != 0 || parts.is_alone(vertex)) continue;
            if (held_bodies[at(bodies.root(vertex))] == 0) continue;
            numbers[root] = 0;
        }
    }
    int next = 0;
    for (auto& [root, number] : numbers) number = next++;
    return numbers;
}

}  // namespace

TieTable find_part_ties(const Model& model) {
    Parts parts(model.vertex_count());
    const std::vector<Ends> ties = find_ties(model, parts);
    if (ties.empty()) return {};
    const std::map<int, int> numbers = number_parts(model, parts, ties);
    const auto part_of = [&](int vertex) {
        const auto found = numbers.find(parts.root(vertex));
        return found == numbers.end() ? PartTie::kNone : found->second;
    };
    TieTable table{std::vector<std::vector<int>>(numbers.size()), {}};
    for (int v = 0; v < model.vertex_count(); ++v) {
        if (const int part = part_of(v); part != PartTie::kNone) {
            table.vertices[at(part)].push_back(v);
        }
    }
    for (const Ends& ends : ties) {
        const auto [a, b] = std::pair(part_of(ends.a), part_of(ends.b));
        if (parts.root(ends.a) == parts.root(ends.b)) continue;
        if (a != PartTie::kNone) table.ties.push_back({a, ends.a, ends.b, b, ends.tie});
        if (b != PartTie::kNone) table.ties.push_back({b, ends.b, ends.a, a, ends.tie});
    }
    std::ranges::stable_sort(table.ties, {}, &PartTie::part);
    return table;
}

}  // namespace weft
