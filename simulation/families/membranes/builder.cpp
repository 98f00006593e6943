#include "simulation/families/builder.h"
#include "simulation/families/membranes/membranes.h"

namespace weft {

namespace {

class MembranesBuilder final : public FamilyBuilder {
public:
    MembranesBuilder() : FamilyBuilder({"membranes", "membranes", "membrane"}, 3) {}

    void add(const ClothPart& part) override {
        if (!part.cloth.membrane) return;
        append(part.mesh.triangles, part.first_vertex);
        fill(stiffness_, stiffness_of(*part.cloth.membrane));
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
            rest_.push_back(laid_flat(part.mesh.rest_of(t)));
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<Membranes>(names(), stencils(), strips, rest_, stiffness_);
    }

    void add_resistance(std::span<const Vec3> /*rest*/, Vec3 /*along*/,
                        std::span<double> resistance) const override {
        for (int t = 0; t < stencils().count(); ++t) {
            const auto& [width, along, height] = rest_[static_cast<std::size_t>(t)];
            const auto& [mu, lambda] = stiffness_[static_cast<std::size_t>(t)];
            for (const int v : stencils()[t]) {
                resistance[static_cast<std::size_t>(v)] += (mu + lambda) * width * height / 6.0;
            }
        }
    }

    std::vector<Absence> absences(const Scene& /*scene*/, bool exists) const override {
        if (exists) return {};
        return {{"membranes", "no cloth has a membrane"}};
    }

private:
    std::vector<FlatTriangle> rest_;    ///< [triangles]
    std::vector<Stiffness> stiffness_;  ///< [triangles] [N/m]
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_membranes_builder() {
    return std::make_unique<MembranesBuilder>();
}

}  // namespace weft
