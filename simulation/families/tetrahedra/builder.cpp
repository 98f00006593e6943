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
