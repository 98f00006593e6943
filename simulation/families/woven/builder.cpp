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

    void add_resistance(std::span<const Vec3> rest, Vec3 along,
                        std::span<double> resistance) const override {
        for (int t = 0; t < stencils().count(); ++t) {
            const auto i = static_cast<std::size_t>(t);
            const auto x = [&](std::size_t k) {
                return rest[static_cast<std::size_t>(stencils()[t][k])];
            };
            const Vec3 warp = warp_[i][0] * (x(1) - x(0)) + warp_[i][1] * (x(2) - x(0));
            if (length(warp) == 0.0) continue;
            const double cosine = dot(normalized(warp), along);
            const double warps = cosine * cosine;
            const double wefts = 1.0 - warps;
            const auto& [k_warp, k_weft, k_shear] = stiffness_[i];
            const double stiffness =
                k_warp * warps * warps + k_weft * wefts * wefts + 4.0 * k_shear * warps * wefts;
            const double area = 0.5 * length(cross(edges_[i][0], edges_[i][1]));
            for (const int v : stencils()[t]) {
                resistance[static_cast<std::size_t>(v)] += stiffness * area / 3.0;
            }
        }
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
