#include "simulation/model/springs.h"

#include "simulation/model/convert.h"

namespace weft {

Springs::Springs(const Stencils& springs, const Strips& strips, std::span<const Vec3> rest,
                 std::span<const double> stiffness, int edges)
    : elements("springs", springs, strips),
      material("springs.material", 2 * static_cast<std::size_t>(elements.count())),
      edge_count(edges) {
    const auto count = static_cast<std::size_t>(elements.count());
    for (std::size_t s = 0; s < count; ++s) {
        const int original = elements.original(static_cast<int>(s));
        const auto ends = springs[original];
        const Vec3 along =
            rest[static_cast<std::size_t>(ends[0])] - rest[static_cast<std::size_t>(ends[1])];
        material[s] = static_cast<float>(length(along));
        material[count + s] =
            static_cast<float>(1.0 / stiffness[static_cast<std::size_t>(original)]);
    }
}

double Springs::energy(std::span<const float4> positions) const {
    double sum = 0.0;
    for (int s = 0; s < elements.count(); ++s) {
        const auto ends = elements.vertices_of(s);
        const Vec3 along = to_vec3(positions[static_cast<std::size_t>(ends[0])]) -
                           to_vec3(positions[static_cast<std::size_t>(ends[1])]);
        const double stretch = length(along) - rest_length(s);
        sum += 0.5 * stiffness(s) * stretch * stretch;
    }
    return sum;
}

}  // namespace weft
