#include <cmath>

#include "runtime/tbb/parallel.h"
#include "simulation/families/builder.h"
#include "simulation/families/curved_hinges/curved_hinges.h"
#include "simulation/families/hinges/hinge_shape.h"

namespace weft {

namespace {

class CurvedHingesBuilder final : public FamilyBuilder {
public:
    CurvedHingesBuilder() : FamilyBuilder({"curved_hinges", "curved bending", "curved_bend"}, 4) {}

    void add(const ClothPart& part) override {
        if (!part.cloth.bend || part.cloth.bend->rest_is_flat) return;
        const double root = std::sqrt(part.cloth.bend->stiffness);
        const std::vector<char> are_flat = find_flat(part);
        for (int h = 0; h < part.adjacency.hinges.count(); ++h) {
            if (are_flat[static_cast<std::size_t>(h)] != 0) continue;
            const auto vertices = part.adjacency.hinges[h];
            const HingeCorners corners = part.rest.hinge(vertices);
            append(vertices, part.first_vertex);
            sines_ += half_fold(corners).sine * half_fold(corners).sine;
            weights_.push_back(curved_hinge_weights(corners));
            for (double& weight : weights_.back()) weight *= root;
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        // Half folds of an eighth of a radian.
        const bool is_nearly_flat = sines_ < 0.02 * static_cast<double>(weights_.size());
        return std::make_unique<CurvedHinges>(names(), stencils(), strips, weights_,
                                              is_nearly_flat);
    }

    /// As of flat ones, which differ from these by how far they are folded.
    void add_firmness(std::span<const Vec3> /*rest*/, Vec3 /*along*/,
                      std::span<double> firmness) const override {
        for (int h = 0; h < stencils().count(); ++h) {
            const auto& q = weights_[static_cast<std::size_t>(h)];
            const std::array<double, 4> weights{-q[0] - q[1] - q[2], q[0], q[1], q[2]};
            for (std::size_t k = 0; k < 4; ++k) {
                firmness[static_cast<std::size_t>(stencils()[h][k])] += weights[k] * weights[k];
            }
        }
    }

    std::vector<Absence> absences(const Scene& /*scene*/, bool exists) const override {
        if (exists) return {};
        return {{"curved bending", "no cloth with bending is folded at rest"}};
    }

private:
    static std::vector<char> find_flat(const ClothPart& part) {
        std::vector<char> are_flat(static_cast<std::size_t>(part.adjacency.hinges.count()));
        for_each_block(part.adjacency.hinges.count(), [&](int /*block*/, int begin, int end) {
            for (int h = begin; h < end; ++h) {
                const HingeCorners corners = part.rest.hinge(part.adjacency.hinges[h]);
                are_flat[static_cast<std::size_t>(h)] = half_fold(corners).is_flat() ? 1 : 0;
            }
        });
        return are_flat;
    }

    std::vector<CurvedHinges::Weights> weights_;  ///< [hinges]
    double sines_ = 0.0;                          ///< sum of squares, of half the folds
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_curved_hinges_builder() {
    return std::make_unique<CurvedHingesBuilder>();
}

}  // namespace weft
