#include "simulation/families/stitches/seam_edge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/bodies/selection.h"
#include "simulation/mesh/border.h"

namespace weft {

namespace {

std::vector<double> places_along(const BorderChain& chain, const RestShape& rest) {
    std::vector<double> places{0.0};
    const std::size_t count = chain.vertices.size();
    for (std::size_t i = 1; i <= count; ++i) {
        if (i == count && !chain.is_closed) break;
        places.push_back(places.back() +
                         rest.length_of(chain.vertices[i - 1], chain.vertices[i % count]));
    }
    const double whole = places.back();
    for (double& place : places) place /= whole;
    places.resize(count);
    return places;
}

double distance_of(double a, double b, bool is_closed) {
    const double apart = std::abs(a - b);
    return is_closed ? std::min(apart, 1.0 - apart) : apart;
}

/// The same edge, run through the other way.
SeamEdge reversed(SeamEdge edge) {
    std::reverse(edge.vertices.begin(), edge.vertices.end());
    std::reverse(edge.places.begin(), edge.places.end());
    const double last = edge.is_closed ? edge.places.front() : 1.0;
    for (double& place : edge.places) place = last - place;
    return edge;
}

/// A loop that begins at another of its vertices.
SeamEdge begun_at(SeamEdge loop, std::size_t first) {
    const double start = loop.places[first];
    for (double& place : loop.places) place = place < start ? place - start + 1.0 : place - start;
    const auto shift = static_cast<std::ptrdiff_t>(first);
    std::rotate(loop.places.begin(), loop.places.begin() + shift, loop.places.end());
    std::rotate(loop.vertices.begin(), loop.vertices.begin() + shift, loop.vertices.end());
    return loop;
}

std::size_t nearest(const SeamEdge& edge, double place) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < edge.places.size(); ++i) {
        if (distance_of(edge.places[i], place, edge.is_closed) <
            distance_of(edge.places[best], place, edge.is_closed)) {
            best = i;
        }
    }
    return best;
}

/// The sum of squared distances of a few places of both edges [m^2].
double far_apart(const SeamEdge& a, const SeamEdge& b, std::span<const Vec3> positions) {
    constexpr int kSamples = 16;
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
        const double place = static_cast<double>(i) / (a.is_closed ? kSamples : kSamples - 1);
        const auto at = [&](const SeamEdge& edge) {
            return positions[static_cast<std::size_t>(edge.vertices[nearest(edge, place)])];
        };
        const Vec3 apart = at(a) - at(b);
        sum += dot(apart, apart);
    }
    return sum;
}

/// b, turned and begun so that it is as near to a as may be.
SeamEdge fitted(const SeamEdge& a, const SeamEdge& b, std::span<const Vec3> positions) {
    SeamEdge best = b;
    double least = std::numeric_limits<double>::infinity();
    const std::size_t starts = b.is_closed ? b.vertices.size() : 1;
    // Of a long loop not every beginning is tried: a stitch more or less is no matter.
    const std::size_t step = std::max<std::size_t>(1, starts / 256);
    for (const SeamEdge& way : {b, reversed(b)}) {
        for (std::size_t start = 0; start < starts; start += step) {
            SeamEdge candidate = b.is_closed ? begun_at(way, start) : way;
            const double apart = far_apart(a, candidate, positions);
            if (apart >= least) continue;
            least = apart;
            best = std::move(candidate);
        }
    }
    return best;
}

}  // namespace

SeamEdge find_seam_edge(const Seam& seam, const SeamSide& side, const char* name,
                        const ClothPart& part) {
    const std::string whose = fmt::format("edge {} of a seam, cloth '{}'", name, side.cloth);
    const NamedVertices parts =
        side.selected.parts.empty() ? NamedVertices{} : named_parts(part.mesh);
    const std::vector<int> chosen = selected_vertices(
        side.selected, part.cloth.shape, part.mesh.positions, parts, whose, part.mesh.welded);
    SeamEdge edge;
    if (lists_vertices_alone(side.selected)) {
        edge.vertices = listed_vertices(side.selected, part.mesh.welded);
    } else {
        std::vector<char> is_chosen(part.mesh.positions.size(), 0);
        for (const int vertex : chosen) is_chosen[static_cast<std::size_t>(vertex)] = 1;
        const auto chains = border_chains(part.mesh, is_chosen);
        if (chains.size() != 1) {
            throw UserError(fmt::format("{}: {}: {}", seam.where, whose,
                                        chains.empty()
                                            ? "the selection has no edge of the cloth's border"
                                            : fmt::format("the selection has {} pieces of the "
                                                          "cloth's border; select one",
                                                          chains.size())));
        }
        edge = {chains[0].vertices, places_along(chains[0], part.rest), chains[0].is_closed};
    }
    for (int& vertex : edge.vertices) vertex += part.first_vertex;
    return edge;
}

std::vector<std::array<int, 2>> find_stitches(const Seam& seam, const SeamEdge& a,
                                              const SeamEdge& b, std::span<const Vec3> positions) {
    const bool is_listed = a.places.empty() || b.places.empty();
    if (is_listed && a.vertices.size() != b.vertices.size()) {
        throw UserError(
            fmt::format("{}: a seam between listed vertices joins them one by one: "
                        "edge a has {}, edge b has {}",
                        seam.where, a.vertices.size(), b.vertices.size()));
    }
    if (!is_listed && a.is_closed != b.is_closed) {
        throw UserError(
            fmt::format("{}: edge {} of the seam is a closed loop, and the other one "
                        "is not",
                        seam.where, a.is_closed ? "a" : "b"));
    }
    std::vector<std::array<int, 2>> pairs;
    if (is_listed) {
        for (std::size_t i = 0; i < a.vertices.size(); ++i) {
            pairs.push_back({a.vertices[i], b.vertices[i]});
        }
    } else {
        const SeamEdge other = fitted(a, b, positions);
        for (std::size_t i = 0; i < a.vertices.size(); ++i) {
            pairs.push_back({a.vertices[i], other.vertices[nearest(other, a.places[i])]});
        }
        for (std::size_t i = 0; i < other.vertices.size(); ++i) {
            pairs.push_back({a.vertices[nearest(a, other.places[i])], other.vertices[i]});
        }
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }
    std::erase_if(pairs, [](const auto& pair) { return pair[0] == pair[1]; });
    return pairs;
}

}  // namespace weft
