#include <cmath>

#include "simulation/families/builder.h"
#include "simulation/families/tetrahedra/tetrahedra.h"

namespace weft {

namespace {

class TetrahedraBuilder final : public FamilyBuilder {
public:
    TetrahedraBuilder() : FamilyBuilder({"tetrahedra", "tetrahedra", "solid"}, 4) {}

    void add(const SolidPart& part) override {
        append(part.mesh.tetrahedra, part.first_vertex);
        fill(stiffness_, stiffness_of(part.solid.material));
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> rest) const override {
        return std::make_unique<Tetrahedra>(names(), stencils(), strips, rest, stiffness_);
    }

    void add_firmness(std::span<const Vec3> rest, Vec3 along,
                      std::span<double> firmness) const override {
        for (int t = 0; t < stencils().count(); ++t) {
            const std::span<const int> corners = stencils()[t];
            const auto x = [&](std::size_t k) {
                return rest[static_cast<std::size_t>(corners[k % 4])];
            };
            const double six_volumes = std::abs(dot(cross(x(1) - x(0), x(2) - x(0)), x(3) - x(0)));
            if (six_volumes == 0.0) continue;
            const Stiffness& stiffness = stiffness_[static_cast<std::size_t>(t)];
            for (std::size_t k = 0; k < 4; ++k) {
                // The gradient of the corner's weight, times six volumes.
                const Vec3 gradient = cross(x(k + 2) - x(k + 1), x(k + 3) - x(k + 1));
                const double part = dot(gradient, along);
                firmness[static_cast<std::size_t>(corners[k])] +=
                    (stiffness.mu * dot(gradient, gradient) + stiffness.lambda * part * part) /
                    (6.0 * six_volumes);
            }
        }
    }

    std::vector<Absence> absences(const Scene& /*scene*/, bool exists) const override {
        if (exists) return {};
        return {{"solids", "the scene has no [[solid]]"}};
    }

private:
    std::vector<Stiffness> stiffness_;  ///< [tetrahedra] [Pa]
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_tetrahedra_builder() {
    return std::make_unique<TetrahedraBuilder>();
}

}  // namespace weft
