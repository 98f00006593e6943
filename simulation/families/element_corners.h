#pragma once

#include "simulation/families/elements.h"
#include "simulation/topology/grouped.h"

namespace weft {

/// A corner of an element, seen from the vertex that it is at.
struct ElementCorner {
    int element;
    int corner;
};

/// Of each vertex, by ascending element.
inline Grouped<ElementCorner> corners_at_vertices(const Elements& elements, int vertex_count) {
    return {vertex_count, [&](const auto& put) {
                for (int e = 0; e < elements.count(); ++e) {
                    int corner = 0;
                    for (const int vertex : elements.vertices_of(e)) {
                        put(vertex, ElementCorner{e, corner++});
                    }
                }
            }};
}

}  // namespace weft
