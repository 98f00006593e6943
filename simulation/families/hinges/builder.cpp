#include <algorithm>
#include <cmath>

#include "simulation/families/builder.h"
#include "simulation/families/hinges/hinge_shape.h"
#include "simulation/families/hinges/hinges.h"

namespace weft {

namespace {

class HingesBuilder final : public FamilyBuilder {
public:
    HingesBuilder() : FamilyBuilder({"hinges", "bending", "bend"}, 4) {}

    void add(const ClothPart& part) override {
        if (!part.cloth.bend) return;
        const double root = std::sqrt(part.cloth.bend->stiffness);
        const auto most = static_cast<std::size_t>(part.adjacency.hinges.count());
        reserve(most);
        weights_.reserve(weights_.size() + most);
        for (int h = 0; h < part.adjacency.hinges.count(); ++h) {
            const auto vertices = part.adjacency.hinges[h];
            const HingeCorners corners = part.rest.hinge(vertices);
            if (!part.cloth.bend->rest_is_flat && !half_fold(corners).is_flat()) continue;
            append(vertices, part.first_vertex);
            std::ranges::transform(
                hinge_weights(corners), weights_.emplace_back().begin(),
                [&](double weight) { return static_cast<float>(weight * root); });
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<Hinges>(names(), stencils(), strips, weights_);
    }

    std::vector<Absence> absences(const Scene& scene, bool exists) const override {
        if (exists) return {};
        const bool asked = std::ranges::any_of(
            scene.cloths, [](const Cloth& cloth) { return cloth.bend.has_value(); });
        return {{"bending", asked ? "no edge between exactly two triangles is flat at rest"
                                  : "no cloth has bend.stiffness above 0"}};
    }

private:
    /// [hinges] [sqrt(J) / m] as the table will have them
    std::vector<std::array<float, 4>> weights_;
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_hinges_builder() { return std::make_unique<HingesBuilder>(); }

}  // namespace weft
