#include "simulation/families/hinges/hinges.h"

namespace weft {

Hinges::Hinges(const FamilyNames& names, const Stencils& hinges, const Strips& strips,
               std::span<const std::array<float, 4>> given)
    : ElementFamily(names, hinges, strips),
      weights("hinges.weights", 4 * static_cast<std::size_t>(hinges.count())) {
    const auto count = static_cast<std::size_t>(hinges.count());
    for (std::size_t h = 0; h < count; ++h) {
        const auto original = static_cast<std::size_t>(elements().original(static_cast<int>(h)));
        for (std::size_t k = 0; k < 4; ++k) {
            weights[k * count + h] = given[original][k];
        }
    }
}

}  // namespace weft
