#include "simulation/families/builder.h"
#include "simulation/families/woven/warp.h"
#include "simulation/families/woven/woven.h"
#include "simulation/scene/elements/woven.h"

namespace weft {

namespace {

class WovenBuilder final : public FamilyBuilder {
public:
    WovenBuilder() : FamilyBuilder({"woven", "woven cloth", "woven"}, 3) {}

    void add(const ClothPart& part) override {
        const Woven* woven = part.cloth.elements.find<Woven>();
        if (woven == nullptr) return;
        append(part.mesh.triangles, part.first_vertex);
        fill(stiffness_, WovenStiffness{woven->warp, woven->weft, woven->shear});
        const auto warp = warp_directions(part.cloth, *woven, part.mesh);
        warp_.insert(warp_.end(), warp.begin(), warp.end());
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
            const auto [a, b, c] = part.mesh.rest_of(t);
            edges_.push_back({b - a, c - a});
        }
    }

    std::unique_ptr<ElementFamily> build(const Strips& strips,
                                         std::span<const Vec3> /*rest*/) const override {
        return std::make_unique<WovenCloth>(names(), stencils(), strips, edges_, warp_, stiffness_);
    }

    std::vector<Absence> absences(const Scene& /*scene*/, bool exists) const override {
        if (exists) return {};
        return {{"woven cloth", "no cloth is woven"}};
    }

private:
    std::vector<std::array<Vec3, 2>> edges_;  ///< [triangles] at rest [m]
    std::vector<WarpDirection> warp_;         ///< [triangles]
    std::vector<WovenStiffness> stiffness_;   ///< [triangles] [N/m]
};

}  // namespace

std::unique_ptr<FamilyBuilder> make_woven_builder() { return std::make_unique<WovenBuilder>(); }

}  // namespace weft
