#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/crossings.h"
#include "simulation/model/model.h"
#include "simulation/model/triangle_distance.h"

namespace weft {

/// The triangles of a model whose scene has [contact], and which pairs of them contact looks at:
/// not those that are tied to each other where it is made, both held, or of one body without
/// contact.self.
class ContactSurface {
public:
    /// Where the model is.
    explicit ContactSurface(const Model& model);
    /// To where it is by now.
    void move(const Model& model);

    PlainSurface surface() const { return {positions_, triangles_}; }
    Corners corners(int t) const {
        return {surface().corner(t, 0), surface().corner(t, 1), surface().corner(t, 2)};
    }
    int body(int t) const { return bodies_[static_cast<std::size_t>(t)]; }
    Vec3 position(int vertex) const { return positions_[static_cast<std::size_t>(vertex)]; }
    int knot(int vertex) const { return knots_[static_cast<std::size_t>(vertex)]; }
    bool is_tied(int vertex) const { return tied_[static_cast<std::size_t>(vertex)] != 0; }
    const std::array<int, 3>& triangle(int t) const {
        return triangles_[static_cast<std::size_t>(t)];
    }

    bool counts(int a, int b) const;
    bool share_a_vertex(int a, int b) const;
    /// Pairs that contact looks at, and that cross.
    std::vector<TrianglePair> crossings(const BoxTree& tree) const;

private:
    bool is_held(int t) const;
    bool share_a_knot(int a, int b) const;

    bool touches_itself_;
    std::vector<std::array<int, 3>> triangles_;
    std::vector<int> bodies_;      ///< [triangles]
    std::vector<Vec3> positions_;  ///< in scene order
    std::vector<char> held_;       ///< likewise
    std::vector<int> knots_;       ///< likewise
    std::vector<char> tied_;       ///< likewise: whether a knot has others
};

/// "cloth 'a'"
std::string body_name(const BodyRange& body);
/// "cloth 'a' triangle 3"
std::string triangle_name(const Model& model, int triangle);
/// "cloth 'a' triangle 3 and cloth 'b' triangle 5"
std::string name_of_pair(const Model& model, const TrianglePair& pair);
/// "2 pairs of triangles cross: ...", with the first `most` of them
std::string text_of_crossings(const Model& model, const std::vector<TrianglePair>& pairs,
                              std::size_t most);

}  // namespace weft
