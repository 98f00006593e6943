#include "simulation/contact/knots.h"

#include <algorithm>
#include <set>

#include "simulation/families/convert.h"
#include "simulation/mesh/vertex_sets.h"

namespace weft {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Edges of triangles, lower vertex first: their springs tie nothing together.
std::set<std::pair<int, int>> edges_of(const Model& model) {
    std::set<std::pair<int, int>> edges;
    for (const auto& t : model.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.insert(std::minmax(model.vertex(SceneVertex{t[k]}),
                                     model.vertex(SceneVertex{t[(k + 1) % 3]})));
        }
    }
    return edges;
}

bool has_ties(const Scene& scene) { return !scene.seams.empty() || !scene.attachments.empty(); }

}  // namespace

std::vector<int> knots_of(const Model& model, double thickness) {
    VertexSets sets(model.vertex_count());
    if (has_ties(model.scene)) {
        const auto edges = edges_of(model);
        const auto distance = [&](int a, int b) {
            return length(to_vec3((*model.positions)[at(a)]) - to_vec3((*model.positions)[at(b)]));
        };
        for (const auto& family : model.families) {
            for (int e = 0; e < family->count(); ++e) {
                if (family->corners(e).size() != 2) break;
                const int a = family->corners(e)[0], b = family->corners(e)[1];
                if (edges.contains(std::minmax(a, b))) continue;
                if (family->brings_together() || distance(a, b) <= thickness) sets.unite(a, b);
            }
        }
    }
    std::vector<int> knots(at(model.vertex_count()));
    for (int v = 0; v < model.vertex_count(); ++v) knots[at(v)] = sets.least(v);
    return knots;
}

}  // namespace weft
