#pragma once

#include <cstdint>
#include <span>

#include "simulation/families/elements.h"
#include "simulation/topology/grouped.h"

namespace weft {

/// Two corners of an element. There are dozens per vertex while tables are made, so they are small.
struct Coupling {
    int element = 0;
    std::int16_t j = 0;  ///< corner of the vertex whose it is, or of a block's row
    std::int16_t k = 0;  ///< and of the other vertex, or of a block's column
};

/// Per vertex what couples it with others: by ascending other vertex, and with each by ascending
/// element.
class Couplings {
public:
    /// The elements must outlive it.
    Couplings(const Elements& elements, int vertex_count);

    int vertex_count() const { return rows_.count(); }
    /// How many others a vertex is coupled with.
    int other_count(int vertex) const;
    /// Calls visit(other, all its couplings with the vertex), by ascending other.
    template <class Visit>
    void for_each_other(int vertex, const Visit& visit) const {
        for (std::span<const Coupling> left = rows_[vertex]; !left.empty();) {
            const int other = other_of(left.front());
            std::size_t count = 1;
            while (count < left.size() && other_of(left[count]) == other) ++count;
            visit(other, left.first(count));
            left = left.subspan(count);
        }
    }
    /// Vertex by vertex, as for_each_other() has them.
    std::span<const Coupling> all() const { return rows_.values(); }

private:
    int other_of(const Coupling& c) const { return elements_.vertex_of(c.element, c.k); }

    const Elements& elements_;
    Grouped<Coupling> rows_;  ///< [vertices]
};

}  // namespace weft
