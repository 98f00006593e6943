#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simulation/topology/stencils.h"

namespace weft {

/// Colours groups of elements of one kind so that elements of one colour share no vertex.
class Colourer {
public:
    /// kind  must outlive the colourer; vertices in [0, vertex_count)
    Colourer(const Stencils& kind, int vertex_count);

    /// The most elements of the group at one vertex: no colouring has fewer colours.
    int lower_bound(std::span<const int> elements);

    /// Writes colour[e] for each e in `elements`, in colours of about equal size, and returns their
    /// number. Looks for a better colouring for a while if greedy takes more than `goal` colours.
    int colour_group(std::span<const int> elements, int goal, std::span<int> colour);

private:
    int first_fit(std::span<const int> elements, std::span<int> colour);
    int improve(std::span<const int> elements, int count, int goal, std::span<int> colour);
    void balance(std::span<const int> elements, int count, std::span<int> colour);
    void sort_by_colour(std::span<const int> place, std::span<const int> colour);
    std::uint64_t taken(int element) const;
    void toggle(int element, int bit);
    void forget(std::span<const int> elements);

    const Stencils& kind_;
    /// [vertex_count] bit c: an element of colour c is here. All 0 between calls.
    std::vector<std::uint64_t> taken_;
    std::vector<int> sequence_;  ///< the group's elements, in the order in which to colour them
    std::vector<int> scratch_;
};

}  // namespace weft
