#include "simulation/topology/stencil_layout.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "scheduler/assert.h"
#include "simulation/topology/vertex_groups.h"

namespace weft {

namespace {

/// Which vertices form stencils, and of what.
class Choice {
public:
    Choice(std::span<const StencilCandidates> candidates, const std::vector<Place>& places)
        : candidates_(candidates),
          groups_(static_cast<int>(places.size())),
          family_(places.size(), static_cast<int>(candidates.size())),
          element_(places.size()) {
        std::iota(element_.begin(), element_.end(), 0);
        for (std::size_t f = 0; f < candidates.size(); ++f) {
            for (const int element : candidates[f].order) {
                const std::span<const int> vertices = candidates[f].elements[element];
                const bool fits = std::all_of(vertices.begin(), vertices.end(), [&](int v) {
                    return groups_.is_single(v) && places[v] == places[vertices[0]];
                });
                if (!fits) continue;
                groups_.unite(vertices);
                family_[groups_.leader(vertices[0])] = static_cast<int>(f);
                element_[groups_.leader(vertices[0])] = element;
            }
        }
    }
    const Groups& groups() const { return groups_; }

    // Of the stencil that a leader stands for.
    std::size_t family(int leader) const { return static_cast<std::size_t>(family_[leader]); }
    /// That of the vertex, if it is single.
    int element(int leader) const { return element_[leader]; }
    int corner(int leader, std::size_t number) const {
        if (family(leader) == candidates_.size()) return leader;
        return candidates_[family(leader)].elements[element_[leader]][number];
    }

    /// Of all corners. Rows of elements that share a pack are about as long when stencils lie by
    /// these.
    std::size_t neighbours(const VertexGraph& graph, int leader, int corners) const {
        std::size_t count = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(corners); ++k) {
            count += graph.neighbours(corner(leader, k)).size();
        }
        return count;
    }

private:
    std::span<const StencilCandidates> candidates_;
    Groups groups_;
    std::vector<int> family_;
    std::vector<int> element_;
};

/// The stencils of one family in a segment.
void add_segment(std::span<const int> leaders, const Choice& choice, std::vector<int>& vertices,
                 StencilLayout::Family& family) {
    const auto first = static_cast<int>(vertices.size());
    const auto count = static_cast<int>(leaders.size());
    for (int corner = 0; corner < family.arity; ++corner) {
        for (const int leader : leaders) {
            vertices.push_back(choice.corner(leader, static_cast<std::size_t>(corner)));
        }
    }
    for (int i = 0; i < count; ++i) {
        family.elements.push_back(choice.element(leaders[i]));
        std::array<int, 4>& corners = family.corners.emplace_back();
        for (int corner = 0; corner < family.arity; ++corner) {
            corners[corner] = first + corner * count + i;
        }
    }
    family.segment_begin.push_back(static_cast<int>(family.elements.size()));
}

}  // namespace

StencilLayout make_stencil_layout(std::span<const Stencils> kinds, const Strips& strips,
                                  std::span<const StencilCandidates> candidates) {
    const VertexGraph graph(static_cast<int>(strips.order.size()), kinds);
    const std::vector<Place> places = find_places(graph, strips);
    const Choice choice(candidates, places);
    StencilLayout layout;
    VertexLayout& items = layout.items;
    const std::vector<int> leaders =
        sort_into_segments(graph, strips, places, choice.groups(), items);
    const std::vector<int> begin = std::exchange(items.segment_begin, {0});

    WEFT_ASSERT(std::ranges::is_sorted(begin));
    layout.families.resize(candidates.size() + 1);
    for (std::size_t f = 0; f < layout.families.size(); ++f) {
        layout.families[f].segment_begin = {0};
        if (f < candidates.size()) layout.families[f].arity = candidates[f].elements.arity;
    }
    for (std::size_t s = 0; s + 1 < begin.size(); ++s) {
        std::vector<std::vector<int>> members(layout.families.size());
        for (int i = begin[s]; i < begin[s + 1]; ++i) {
            members[choice.family(leaders[i])].push_back(leaders[i]);
        }
        for (std::size_t f = 0; f < members.size(); ++f) {
            std::ranges::stable_sort(members[f], std::greater{}, [&](int leader) {
                return choice.neighbours(graph, leader, layout.families[f].arity);
            });
            add_segment(members[f], choice, items.vertices, layout.families[f]);
        }
        items.segment_begin.push_back(static_cast<int>(items.vertices.size()));
    }
    WEFT_ASSERT(items.vertices.size() == strips.order.size());
    return layout;
}

}  // namespace weft
