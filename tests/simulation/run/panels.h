#pragma once

#include <array>
#include <string>
#include <vector>

#include "simulation/mesh/vec3.h"

namespace weft::test {

/// An irregular sheet, whole, and cut into a left and a right half with a border of their own each
/// (groups "left" and "right"). The whole one's vertices come first in the cut one, in the same
/// order, then the right half's own ones along the cut; triangles have one order.
struct Panels {
    std::vector<Vec3> positions;  ///< of the whole
    std::vector<std::array<int, 3>> left, right;
    std::vector<std::array<int, 2>> cut;  ///< left half's vertex, right half's

    static Panels make();
    std::string whole_obj() const;
    std::string cut_obj() const;
    /// [m] how far the right half is put away to the right
    std::string cut_obj(double apart) const;
};

/// The file's path, in the folder of the tests.
std::string write_obj(const std::string& name, const std::string& text);

}  // namespace weft::test
