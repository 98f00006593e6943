#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace weft {

/// Sets of vertices that grow together; the least vertex of each names it.
class VertexSets {
public:
    explicit VertexSets(int vertices) : parent_(static_cast<std::size_t>(vertices)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    int least(int vertex) {
        while (parent(vertex) != vertex) vertex = parent(vertex) = parent(parent(vertex));
        return vertex;
    }
    void unite(int a, int b) {
        a = least(a);
        b = least(b);
        parent(std::max(a, b)) = std::min(a, b);
    }

private:
    int& parent(int vertex) { return parent_[static_cast<std::size_t>(vertex)]; }

    std::vector<int> parent_;
};

}  // namespace weft
