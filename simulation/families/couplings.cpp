#include "simulation/families/couplings.h"

#include "simulation/families/element_corners.h"

namespace weft {

namespace {

/// Those of the other corners with this one.
template <class Put>
void put_couplings(const Elements& elements, const ElementCorner& at, const Put& put) {
    const auto k = static_cast<std::int16_t>(at.corner);
    for (std::int16_t j = 0; j < elements.arity(); ++j) {
        if (j != k) put(elements.vertex_of(at.element, j), Coupling{at.element, j, k});
    }
}

/// The others come one by one, so that nothing has to be sorted.
Grouped<Coupling> couple(const Elements& elements, int vertex_count) {
    const Grouped<ElementCorner> corners = corners_at_vertices(elements, vertex_count);
    const std::size_t others = static_cast<std::size_t>(elements.arity()) - 1;
    return {vertex_count, [&](int vertex) { return others * corners[vertex].size(); },
            [&](const auto& put) {
                for (int other = 0; other < vertex_count; ++other) {
                    for (const ElementCorner& at : corners[other]) {
                        put_couplings(elements, at, put);
                    }
                }
            }};
}

}  // namespace

Couplings::Couplings(const Elements& elements, int vertex_count)
    : elements_(elements), rows_(couple(elements, vertex_count)) {}

int Couplings::other_count(int vertex) const {
    int count = 0;
    for_each_other(vertex, [&](int, std::span<const Coupling>) { ++count; });
    return count;
}

}  // namespace weft
