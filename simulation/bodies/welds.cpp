#include "simulation/bodies/welds.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/selection.h"
#include "simulation/mesh/border.h"
#include "simulation/mesh/weld.h"

namespace weft {
namespace {

using Pairs = std::vector<std::array<int, 2>>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One seam of a cloth, while its pairs are looked for.
class SeamWeld {
public:
    SeamWeld(const TriangleMesh& mesh, const Cloth& cloth, const Weld& weld,
             std::span<const double> reach)
        : mesh_(mesh), cloth_(cloth), weld_(weld), reach_(reach) {}

    Pairs pairs() const {
        const std::vector<int> a = edge(weld_.a, "a"), b = edge(weld_.b, "b");
        if (!lists_vertices_alone(weld_.a) || !lists_vertices_alone(weld_.b)) {
            Pairs pairs = nearest_pairs(a, b, "b");
            const Pairs others = nearest_pairs(b, a, "a");
            pairs.insert(pairs.end(), others.begin(), others.end());
            return pairs;
        }
        const auto& [first, second] = std::pair(weld_.a.vertices, weld_.b.vertices);
        if (first.size() != second.size()) {
            throw UserError(
                fmt::format("{}: a seam between listed vertices joins them one by one: "
                            "edge a has {}, edge b has {}",
                            weld_.where, first.size(), second.size()));
        }
        Pairs pairs;
        for (std::size_t i = 0; i < first.size(); ++i) {
            check_together(first[i], second[i], "b");
            pairs.push_back({first[i], second[i]});
        }
        return pairs;
    }

private:
    /// What a side selects of the border, or lists.
    std::vector<int> edge(const Selection& side, const char* name) const {
        const std::string whose = fmt::format("edge {} of a seam, cloth '{}'", name, cloth_.name);
        std::vector<int> vertices =
            selected_vertices(side, cloth_.shape, mesh_.positions,
                              side.parts.empty() ? NamedVertices{} : named_parts(mesh_), whose);
        if (lists_vertices_alone(side)) return vertices;
        std::vector<char> chosen(mesh_.positions.size(), 0);
        for (const int v : vertices) chosen[at(v)] = 1;
        vertices.clear();
        for (const BorderChain& chain : border_chains(mesh_, chosen)) {
            vertices.insert(vertices.end(), chain.vertices.begin(), chain.vertices.end());
        }
        if (!vertices.empty()) return vertices;
        throw UserError(fmt::format("{}: {}: the selection has no edge of the cloth's border",
                                    weld_.where, whose));
    }

    /// Each vertex with the nearest one of the other edge, which must be where it is.
    Pairs nearest_pairs(std::span<const int> from, std::span<const int> to,
                        const char* other) const {
        Pairs pairs;
        for (const int v : from) {
            const int nearest =
                *std::ranges::min_element(to, {}, [&](int w) { return apart(v, w); });
            check_together(v, nearest, other);
            pairs.push_back({v, nearest});
        }
        return pairs;
    }

    double apart(int v, int w) const {
        return length(mesh_.positions[at(v)] - mesh_.positions[at(w)]);
    }

    void check_together(int v, int w, const char* other) const {
        const double reach = std::min(reach_[at(v)], reach_[at(w)]);
        if (v == w || apart(v, w) <= reach) return;
        throw UserError(fmt::format(
            "{}: weld = true: vertex {} of cloth '{}' is {:.3g} m away from vertex {} of edge {} "
            "at time 0, more than {:.3g} m (a hundredth of their shortest edge); only what lies "
            "together becomes one. Leave weld out, and give stiffness and time: then the seam "
            "draws its edges together and holds them",
            weld_.where, v, cloth_.name, apart(v, w), w, other, reach));
    }

    const TriangleMesh& mesh_;
    const Cloth& cloth_;
    const Weld& weld_;
    std::span<const double> reach_;
};

}  // namespace

void weld_cloth(TriangleMesh& mesh, const Cloth& cloth, Warnings& warnings) {
    if (!cloth.weld && cloth.welds.empty()) return;
    const std::vector<double> reach = weld_reach(mesh);
    Pairs pairs;
    if (cloth.weld) pairs = coincident_border(mesh, reach);
    if (cloth.weld && pairs.empty()) {
        warnings.push_back(fmt::format(
            "{}: cloth '{}': weld = true: no two vertices of the mesh's border lie in one place "
            "(within a hundredth of their shortest edge)",
            cloth.where, cloth.name));
    }
    for (const Weld& one : cloth.welds) {
        const Pairs of_seam = SeamWeld(mesh, cloth, one, reach).pairs();
        pairs.insert(pairs.end(), of_seam.begin(), of_seam.end());
    }
    weld(mesh, pairs,
         fmt::format("{}: weld = true of cloth '{}'",
                     cloth.welds.empty() ? cloth.where : cloth.welds.front().where, cloth.name));
}

}  // namespace weft
