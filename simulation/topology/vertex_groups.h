#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "simulation/topology/strips.h"
#include "simulation/topology/vertex_graph.h"
#include "simulation/topology/vertex_layout.h"

namespace weft {

/// Where a vertex is computed: in a seam or inside a strip.
struct Place {
    int phase;
    int strip;

    bool operator==(const Place&) const = default;
};

std::vector<Place> find_places(const VertexGraph& graph, const Strips& strips);

/// Vertices that are computed together.
class Groups {
public:
    /// Each vertex by itself.
    explicit Groups(int vertex_count)
        : next_(static_cast<std::size_t>(vertex_count)), leader_(next_.size()) {
        std::iota(next_.begin(), next_.end(), 0);
        leader_ = next_;
    }
    void unite(std::span<const int> vertices) {
        const int lowest = *std::min_element(vertices.begin(), vertices.end());
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            next_[vertices[k]] = vertices[(k + 1) % vertices.size()];
            leader_[vertices[k]] = lowest;
        }
    }
    bool is_single(int vertex) const { return next_[vertex] == vertex; }
    /// The lowest vertex of the group.
    int leader(int vertex) const { return leader_[vertex]; }
    bool leads(int vertex) const { return leader_[vertex] == vertex; }

    template <class Visit>
    void for_each_member(int vertex, Visit visit) const {
        int member = vertex;
        do {
            visit(member);
            member = next_[member];
        } while (member != vertex);
    }

private:
    std::vector<int> next_;  ///< [vertices] a ring through the group
    std::vector<int> leader_;
};

/// The leaders of all groups, sorted by segments, and by vertex within. Fills in the layout's
/// segments, of the leaders. The vertices of a group share a place.
std::vector<int> sort_into_segments(const VertexGraph& graph, const Strips& strips,
                                    const std::vector<Place>& places, const Groups& groups,
                                    VertexLayout& layout);

}  // namespace weft
