#include "simulation/families/couplings.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace weft {

Couplings::Couplings(const Elements& elements, int vertex_count)
    : elements_(elements), rows_(vertex_count, [&](const auto& put) {
          for (int e = 0; e < elements.count(); ++e) {
              const ElementCorners corners = elements.vertices_of(e);
              for (std::size_t j = 0; j < corners.size(); ++j) {
                  for (std::size_t k = 0; k < corners.size(); ++k) {
                      if (k == j) continue;
                      put(corners[j],
                          Coupling{e, static_cast<std::int16_t>(j), static_cast<std::int16_t>(k)});
                  }
              }
          }
      }) {
    std::vector<std::pair<int, Coupling>> keyed;
    for (int v = 0; v < vertex_count; ++v) {
        const std::span<Coupling> row = rows_[v];
        keyed.clear();
        for (const Coupling& c : row) keyed.emplace_back(other_of(c), c);
        std::ranges::sort(keyed, {}, [](const auto& entry) {
            return std::pair(entry.first, entry.second.element);
        });
        std::ranges::transform(keyed, row.begin(), [](const auto& entry) { return entry.second; });
    }
}

int Couplings::other_count(int vertex) const {
    int count = 0;
    for_each_other(vertex, [&](int, std::span<const Coupling>) { ++count; });
    return count;
}

}  // namespace weft
