#include "simulation/contact/incidence.h"

#include <algorithm>
#include <array>
#include <vector>

namespace weft {

namespace {

void copy(const std::vector<int>& from, Buffer<int>& to) { std::ranges::copy(from, to.data()); }

/// As columns of a table, in the model's vertices.
template <std::size_t N>
void fill_columns(const std::vector<std::array<int, N>>& items, const Surface& surface,
                  Buffer<int>& table) {
    for (std::size_t k = 0; k < N; ++k) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            table[k * items.size() + i] = surface.vertices[static_cast<std::size_t>(items[i][k])];
        }
    }
}

}  // namespace

SurfaceIncidence::SurfaceIncidence(const Surface& s)
    : apexes("contact.apexes", s.vertices.size()),
      triangle_begin("contact.triangle_begin", s.triangles_at.begin.size()),
      triangle_list("contact.triangle_list", s.triangles_at.items.size()),
      edge_begin("contact.edge_begin", s.edges_at.begin.size()),
      edge_list("contact.edge_list", s.edges_at.items.size()),
      triangles("contact.triangles", 3 * s.triangles.size()),
      edges("contact.edges", 2 * s.edges.size()) {
    copy(s.vertices, apexes);
    copy(s.triangles_at.begin, triangle_begin);
    copy(s.triangles_at.items, triangle_list);
    copy(s.edges_at.begin, edge_begin);
    copy(s.edges_at.items, edge_list);
    fill_columns(s.triangles, s, triangles);
    fill_columns(s.edges, s, edges);
}

}  // namespace weft
