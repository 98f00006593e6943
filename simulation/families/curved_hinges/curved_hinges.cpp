#include "simulation/families/curved_hinges/curved_hinges.h"

namespace weft {

CurvedHinges::CurvedHinges(const FamilyNames& names, const Stencils& hinges, const Strips& strips,
                           std::span<const Weights> given, bool is_nearly_flat)
    : ElementFamily(names, hinges, strips),
      weights("curved_hinges.weights", 6 * static_cast<std::size_t>(hinges.count())),
      is_nearly_flat_(is_nearly_flat) {
    const auto count = static_cast<std::size_t>(hinges.count());
    for (std::size_t h = 0; h < count; ++h) {
        const int original = elements().original(static_cast<int>(h));
        for (std::size_t k = 0; k < 6; ++k) {
            weights[k * count + h] =
                static_cast<float>(given[static_cast<std::size_t>(original)][k]);
        }
    }
}

double CurvedHinges::weight(int hinge, int corner) const {
    if (corner > 0) return column(corner - 1, hinge);
    return -(column(0, hinge) + column(1, hinge) + column(2, hinge));
}

double CurvedHinges::pair_weight(int hinge, int j, int k) const {
    if (j == k) return 0.0;
    if (j > k) return -pair_weight(hinge, k, j);
    if (j > 0) return column(j + k, hinge);  // p_12, p_13 and p_23 stand in columns 3, 4 and 5
    double others = 0.0;                     // the weights of a corner's pairs add up to 0
    for (int i = 1; i < 4; ++i) others += pair_weight(hinge, i, k);
    return -others;
}

CurvedHinges::Weights CurvedHinges::seen_from(int hinge, int corner) const {
    const int a = (corner + 1) % 4, b = (corner + 2) % 4, c = (corner + 3) % 4;
    return {weight(hinge, a),         weight(hinge, b),         weight(hinge, c),
            pair_weight(hinge, a, b), pair_weight(hinge, a, c), pair_weight(hinge, b, c)};
}

}  // namespace weft
