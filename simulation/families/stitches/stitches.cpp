#include "simulation/families/stitches/stitches.h"

namespace weft {

Stitches::Stitches(const FamilyNames& names, const Stencils& stitches, const Strips& strips,
                   std::span<const StitchMaterial> materials)
    : ElementFamily(names, stitches, strips),
      material("stitches.material", 3 * static_cast<std::size_t>(stitches.count())) {
    const auto count = static_cast<std::size_t>(stitches.count());
    for (std::size_t s = 0; s < count; ++s) {
        const auto original = static_cast<std::size_t>(elements().original(static_cast<int>(s)));
        const StitchMaterial& given = materials[original];
        material[s] = static_cast<float>(given.start);
        material[count + s] = static_cast<float>(1.0 / given.stiffness);
        material[2 * count + s] = static_cast<float>(given.rate);
    }
}

void Stitches::reserve(int substeps) {
    clock = std::make_unique<Buffer<float>>("stitches.clock", static_cast<std::size_t>(substeps));
}

void Stitches::place(double time, double h) {
    for (std::size_t substep = 0; substep < clock->count(); ++substep) {
        (*clock)[substep] = static_cast<float>(time + static_cast<double>(substep + 1) * h);
    }
}

}  // namespace weft
