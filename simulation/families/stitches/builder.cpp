#include "simulation/families/builder.h"
#include "simulation/families/stitches/seam_edge.h"
#include "simulation/families/stitches/stitches.h"

namespace weft {

namespace {

class StitchesBuilder final : public FamilyBuilder {
public:
    StitchesBuilder() : FamilyBuilder({"stitches", "sewing", "stitch"}, 2) {}

    void add(const ClothPart& part) override {
        edges_.resize(part.scene.seams.size());
        for (std::size_t s = 0; s < edges_.size(); ++s) {
            const Seam& seam = part.scene.seams[s];
            if (seam.a.cloth == part.cloth.name) {
                edges_[s].a = find_seam_edge(seam, seam.a, "a", part);
            }
            if (seam.b.cloth == part.cloth.name) {
                edges_[s].b = find_seam_edge(seam, seam.b, "b", part);
            }
        }
    }

    void add(const ScenePart& part) override {
        for (std::size_t s = 0; s < edges_.size(); ++s) {
            const Seam& seam = part.scene.seams[s];
            const auto pairs = find_stitches(seam, edges_[s].a, edges_[s].b, part.rest);
            append(pairs, 0);
            for (const auto& [a, b] : pairs) {
                const Vec3 apart =
                    part.rest[static_cast<std::size_t>(a)] - part.rest[static_cast<std::size_t>(b)];
                materials_.push_back({length(apart), seam.stiffness, 1.0 / seam.time});
            }
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<Stitches>(names(), stencils(), strips, materials_);
    }

    std::vector<Absence> absences(const Scene& /*scene*/, bool exists) const override {
        if (exists) return {};
        return {{"sewing", "the scene has no [[seam]]"}};
    }

private:
    struct Edges {
        SeamEdge a, b;
    };
    std::vector<Edges> edges_;               ///< [seams]
    std::vector<StitchMaterial> materials_;  ///< [stitches]
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_stitches_builder() {
    return std::make_unique<StitchesBuilder>();
}

}  // namespace weft
