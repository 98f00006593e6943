#include "simulation/checks/start_contacts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/error.h"
#include "runtime/tbb/parallel.h"
#include "simulation/checks/contact_surface.h"
#include "simulation/mesh/vertex_sets.h"
#include "simulation/mesh/winding.h"
#include "simulation/model/contact_thickness.h"
#include "simulation/model/reach.h"
#include "simulation/model/triangle_distance.h"

namespace weft {

namespace {

constexpr std::size_t kNamedPairs = 20;

/// Pairs nearer than `floor` that do not cross.
void find_near(const ContactSurface& start, const BoxTree& tree, double floor,
               StartContacts& contacts) {
    struct Near {
        std::vector<TrianglePair> pairs;
        double least = std::numeric_limits<double>::infinity();
    };
    std::vector<Near> found(static_cast<std::size_t>(block_count(tree.count())));
    for_each_block(tree.count(), [&](int block, int begin, int end) {
        Near& near = found[static_cast<std::size_t>(block)];
        for (int a = begin; a < end; ++a) {
            tree.visit(tree.box(a).grown(floor), [&](int b) {
                if (b <= a || !start.counts(a, b) || start.share_a_vertex(a, b)) return;
                const double distance = distance_of(start.corners(a), start.corners(b));
                if (distance >= floor) return;
                if (std::ranges::binary_search(contacts.crossings, TrianglePair{a, b})) return;
                near.pairs.push_back({a, b});
                near.least = std::min(near.least, distance);
            });
        }
        std::ranges::sort(near.pairs);
    });
    contacts.least = floor;
    for (const Near& near : found) {
        contacts.near.insert(contacts.near.end(), near.pairs.begin(), near.pairs.end());
        contacts.least = std::min(contacts.least, near.least);
    }
}

// ---- bodies upon others ----

/// Whether a corner of the triangle is tied to a vertex of another body in the same place.
bool is_tied_upon(const ContactSurface& start, int t, int corner, double floor,
                  const std::multimap<int, std::pair<int, int>>& by_knot) {
    const auto [first, last] = by_knot.equal_range(start.knot(corner));
    return std::any_of(first, last, [&](const auto& entry) {
        const auto [vertex, body] = entry.second;
        return body != start.body(t) &&
               length(start.position(vertex) - start.position(corner)) <= floor;
    });
}

void find_overlaid(const ContactSurface& start, int triangles, double floor,
                   StartContacts& contacts) {
    std::multimap<int, std::pair<int, int>> by_knot;  // vertex, body
    for (int t = 0; t < triangles; ++t) {
        for (const int v : start.triangle(t)) {
            if (start.is_tied(v)) by_knot.insert({start.knot(v), {v, start.body(t)}});
        }
    }
    for (int t = 0; t < triangles && !by_knot.empty(); ++t) {
        if (std::ranges::all_of(start.triangle(t),
                                [&](int v) { return is_tied_upon(start, t, v, floor, by_knot); })) {
            contacts.overlaid.push_back(t);
        }
    }
}

// ---- bodies inside others ----

/// A part of a body's surface that hangs together.
struct Piece {
    int body;
    int vertex;  ///< the first one
    Bounds box;
};

std::vector<Piece> pieces_of(const Model& model, const ContactSurface& start) {
    VertexSets sets(model.vertex_count());
    for (const auto& t : model.triangles) {
        sets.unite(t[0], t[1]);
        sets.unite(t[1], t[2]);
    }
    std::vector<int> number(static_cast<std::size_t>(model.vertex_count()), -1);
    std::vector<Piece> pieces;
    for (int t = 0; t < static_cast<int>(model.triangles.size()); ++t) {
        const int root = sets.least(model.triangles[static_cast<std::size_t>(t)][0]);
        int& piece = number[static_cast<std::size_t>(root)];
        const Bounds box = start.surface().bounds(t);
        if (piece < 0) {
            piece = static_cast<int>(pieces.size());
            pieces.push_back({start.body(t), root, box});
        }
        pieces[static_cast<std::size_t>(piece)].box.include(box);
    }
    return pieces;
}

/// Triangles of a body: they stand together.
struct TriangleRange {
    int begin = 0, end = 0;
    Bounds box;
};

std::vector<TriangleRange> ranges_of(const Model& model, const ContactSurface& start) {
    std::vector<TriangleRange> ranges(model.bodies.size());
    for (int t = 0; t < static_cast<int>(model.triangles.size()); ++t) {
        TriangleRange& range = ranges[static_cast<std::size_t>(start.body(t))];
        const Bounds box = start.surface().bounds(t);
        if (range.end == 0) range = {t, t, box};
        range.box.include(box);
        range.end = t + 1;
    }
    return ranges;
}

bool is_obstacle(const Model& model, int body) {
    return model.bodies[static_cast<std::size_t>(body)].kind == "obstacle";
}

bool is_within(const Bounds& inner, const Bounds& outer) {
    Bounds both = outer;
    both.include(inner);
    return both.low == outer.low && both.high == outer.high;
}

/// Whether every edge of the triangles [begin, end) has two of them that run through it to and fro.
bool is_closed(const Model& model, int begin, int end) {
    std::map<std::array<int, 2>, int> balance;
    for (int t = begin; t < end; ++t) {
        const auto& corners = model.triangles[static_cast<std::size_t>(t)];
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = corners[k], b = corners[(k + 1) % 3];
            balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}

/// Cloth may be filled. Solids, and obstacles that are closed, have an inside that belongs to
/// nobody else.
bool has_inside(const Model& model, std::size_t body, const TriangleRange& range) {
    if (model.bodies[body].kind == "solid") return true;
    return model.bodies[body].kind == "obstacle" && is_closed(model, range.begin, range.end);
}

void find_swallowed(const Model& model, const ContactSurface& start, StartContacts& contacts) {
    const std::vector<TriangleRange> ranges = ranges_of(model, start);
    const std::vector<Piece> pieces = pieces_of(model, start);
    for (std::size_t b = 0; b < ranges.size(); ++b) {
        if (!has_inside(model, b, ranges[b])) continue;
        for (const Piece& piece : pieces) {
            // Parts of a figure may reach into each other.
            if (static_cast<int>(b) == piece.body || is_obstacle(model, piece.body)) continue;
            if (!is_within(piece.box, ranges[b].box)) continue;
            const double times = winding_number(start.surface(), ranges[b].begin, ranges[b].end,
                                                start.position(piece.vertex));
            if (std::abs(times) < 0.5) continue;
            contacts.swallowed.push_back({piece.body, static_cast<int>(b), piece.vertex});
        }
    }
}

// ---- words ----

class Words {
public:
    explicit Words(const Model& model) : model_(model) {}

    std::string overlaid(const std::vector<int>& triangles) const {
        return fmt::format("{} triangle{} upon what their corners are tied to (the first: {})",
                           triangles.size(), triangles.size() == 1 ? " lies" : "s lie",
                           triangle_name(model_, triangles.front()));
    }
    std::string swallowed(const StartContacts::Swallowed& what) const {
        const BodyRange& body = model_.bodies[static_cast<std::size_t>(what.body)];
        const BodyRange& outer = model_.bodies[static_cast<std::size_t>(what.inside)];
        return fmt::format("{} lies inside {} (vertex {})", body_name(body), body_name(outer),
                           what.vertex - body.first_vertex);
    }

private:
    const Model& model_;
};

std::vector<std::string> what_crosses(const Model& model, const StartContacts& contacts) {
    const Words words(model);
    std::vector<std::string> texts;
    if (!contacts.crossings.empty()) {
        texts.push_back(text_of_crossings(model, contacts.crossings, kNamedPairs));
    }
    if (!contacts.overlaid.empty()) texts.push_back(words.overlaid(contacts.overlaid));
    for (const auto& what : contacts.swallowed) {
        if (texts.size() < kNamedPairs) texts.push_back(words.swallowed(what));
    }
    return texts;
}

}  // namespace

StartContacts find_start_contacts(const Model& model, double floor) {
    const ContactSurface start(model);
    const PlainSurface surface = start.surface();
    const BoxTree tree = surface.tree();
    StartContacts contacts;
    contacts.crossings =
        find_crossings(surface, tree, [&](int a, int b) { return start.counts(a, b); });
    find_near(start, tree, floor, contacts);
    find_overlaid(start, static_cast<int>(model.triangles.size()), floor, contacts);
    if (contacts.crossings.empty()) find_swallowed(model, start, contacts);
    return contacts;
}

void check_start_contacts(const Model& model, OnCrossing on_crossing, Warnings& warnings) {
    const Contact& contact = *model.scene.contact;
    const double floor = contact_floor(contact.thickness, reach_of(model.positions->span()));
    const StartContacts contacts = find_start_contacts(model, floor);
    const std::vector<std::string> texts = what_crosses(model, contacts);
    if (!texts.empty() && on_crossing == OnCrossing::kStop) {
        throw UserError(fmt::format(
            "{}: bodies cross at the start, and [contact] cannot part them: {}; move them apart, "
            "or take --on-crossing warn",
            model.scene.path, fmt::join(texts, "; ")));
    }
    for (const std::string& text : texts) {
        warnings.push_back("at the start " + text + "; contact does not part them");
    }
    if (contacts.near.empty()) return;
    warnings.push_back(fmt::format(
        "{} pair{} of triangles start nearer to each other than {:.3g} m, which contact keeps "
        "surfaces apart, the nearest at {:.3g} m (the first: {}): they may get through each other",
        contacts.near.size(), contacts.near.size() == 1 ? "" : "s", floor, contacts.least,
        name_of_pair(model, contacts.near.front())));
}

}  // namespace weft
