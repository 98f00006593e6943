#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/tbb/parallel.h"
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
        const int most = part.adjacency.hinges.count();
        std::vector<std::optional<Weights>> found(static_cast<std::size_t>(most));
        for_each_block(most, [&](int /*block*/, int begin, int end) {
            for (int h = begin; h < end; ++h) {
                found[static_cast<std::size_t>(h)] = weights_of(part, part.adjacency.hinges[h]);
            }
        });
        reserve(found.size());
        weights_.reserve(weights_.size() + found.size());
        for (int h = 0; h < most; ++h) {
            const auto& weights = found[static_cast<std::size_t>(h)];
            if (!weights) continue;
            append(part.adjacency.hinges[h], part.first_vertex);
            weights_.push_back(*weights);
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<Hinges>(names(), stencils(), strips, weights_);
    }

    /// A hinge at rest is as firm in every direction.
    void add_firmness(std::span<const Vec3> /*rest*/, Vec3 /*along*/,
                      std::span<double> firmness) const override {
        for (int h = 0; h < stencils().count(); ++h) {
            const auto& weights = weights_[static_cast<std::size_t>(h)];
            for (std::size_t k = 0; k < 4; ++k) {
                const auto weight = static_cast<double>(weights[k]);
                firmness[static_cast<std::size_t>(stencils()[h][k])] += weight * weight;
            }
        }
    }

    std::vector<Absence> absences(const Scene& scene, bool exists) const override {
        if (exists) return {};
        const bool asked = std::ranges::any_of(
            scene.cloths, [](const Cloth& cloth) { return cloth.bend.has_value(); });
        return {{"bending", asked ? "no edge between exactly two triangles is flat at rest"
                                  : "no cloth has bend.stiffness above 0"}};
    }

private:
    using Weights = std::array<float, 4>;  ///< [sqrt(J) / m] as the table will have them

    /// None where the hinge is not flat at rest, as curved ones are another family's.
    static std::optional<Weights> weights_of(const ClothPart& part, std::span<const int> hinge) {
        const HingeCorners corners = part.rest.hinge(hinge);
        if (!part.cloth.bend->rest_is_flat && !half_fold(corners).is_flat()) return std::nullopt;
        const double root = std::sqrt(part.cloth.bend->stiffness);
        Weights weights;
        std::ranges::transform(hinge_weights(corners), weights.begin(),
                               [&](double weight) { return static_cast<float>(weight * root); });
        return weights;
    }

    std::vector<Weights> weights_;  ///< [hinges]
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_hinges_builder() { return std::make_unique<HingesBuilder>(); }

}  // namespace weft
