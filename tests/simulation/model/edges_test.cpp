// One measure of strain for all families of elements.

#include "simulation/model/edges.h"

#include <gtest/gtest.h>

#include <set>

#include "simulation/families/convert.h"
#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

Model model_of(const std::string& body) {
    Warnings warnings;
    return {parse_scene("[scene]\nframes = 1\ndt = 0.01\nsubsteps = 2\n" + body, "test.toml"),
            warnings};
}

const std::string kSheet = R"(
[[cloth]]
grid = { size = [1.0, 0.5], resolution = [6, 4] }
density = 0.2
)";
const char* const kCloths[] = {
    "stretch = { stiffness = 10.0 }\n",
    "membrane = { young = 1.0e4, poisson = 0.3, thickness = 1.0e-2 }\n",
    "woven = { warp = 20.0, weft = 10.0, shear = 1.0, direction = [1.0, 0.0, 2.0] }\n",
    "stretch = { stiffness = 10.0 }\nbend = { stiffness = 1.0e-3 }\n"
    "membrane = { young = 1.0e4, poisson = 0.3, thickness = 1.0e-2 }\n",
};

/// Everything `factors` times as long along the axes.
std::vector<float4> stretched(const Model& model, Vec3 factors) {
    std::vector<float4> x;
    for (const float4& p : model.positions->span()) {
        const Vec3 v = to_vec3(p);
        x.push_back(to_float4({factors.x * v.x, factors.y * v.y, factors.z * v.z}));
    }
    return x;
}

/// A grid of 6 x 4 vertices has 5 * 4 + 6 * 3 edges and 5 * 3 diagonals.
TEST(Edges, OfClothAreThoseOfItsTrianglesWhateverItIsMadeOf) {
    for (const char* cloth : kCloths) {
        const Model model = model_of(kSheet + cloth);
        EXPECT_EQ(model.edges->count(), 53) << cloth;
        EXPECT_LT(model.edges->strain(model.positions->span()).most, 1e-6) << cloth;
        const Strain even = model.edges->strain(stretched(model, {1.5, 1.5, 1.5}));
        EXPECT_NEAR(even.rms, 0.5, 1e-6) << cloth;
        EXPECT_NEAR(even.most, 0.5, 1e-6) << cloth;
    }
}

/// Along x only: 20 edges by 0.5, 18 along z not at all, diagonals of 0.2 by 1/6 m by less.
TEST(Edges, CountEachOnceWhereStrainDiffers) {
    const double diagonal = std::hypot(0.3, 1.0 / 6.0) / std::hypot(0.2, 1.0 / 6.0) - 1.0;
    const double expected = std::sqrt((20 * 0.25 + 15 * diagonal * diagonal) / 53.0);
    for (const char* cloth : kCloths) {
        const Model model = model_of(kSheet + cloth);
        const Strain strain = model.edges->strain(stretched(model, {1.5, 1.0, 1.0}));
        EXPECT_NEAR(strain.rms, expected, 1e-5) << cloth;
        EXPECT_NEAR(strain.most, 0.5, 1e-5) << cloth;
    }
}

/// A block of 2 x 2 x 2 vertices: 12 edges, 6 diagonals of faces, one through the middle.
TEST(Edges, OfSolidsAreThoseOfTheirTetrahedra) {
    const Model model = model_of(R"(
[[solid]]
grid = { size = [1.0, 1.0, 1.0], resolution = [2, 2, 2] }
density = 1000.0
young = 1.0e5
poisson = 0.3
)");
    EXPECT_EQ(model.edges->count(), 19);
    const Strain strain = model.edges->strain(stretched(model, {0.5, 0.5, 0.5}));
    EXPECT_NEAR(strain.rms, 0.5, 1e-6);
    EXPECT_NEAR(strain.most, 0.5, 1e-6);
}

TEST(Edges, AttachmentsAreNone) {
    const Model model = model_of(kSheet + kCloths[0] + R"(
[[cloth]]
name = "other"
grid = { size = [1.0, 0.5], resolution = [6, 4] }
translate = [0.0, 1.0, 0.0]
density = 0.2
stretch = { stiffness = 10.0 }
[[attachment]]
a = "other"
b = "cloth0"
corners = ["x-z-"]
stiffness = 10.0
)");
    EXPECT_EQ(model.edges->count(), 106);
}

}  // namespace
}  // namespace weft::test
