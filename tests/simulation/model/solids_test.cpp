// Solids, membranes and attachments as a model has them.

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/error.h"
#include "simulation/families/convert.h"
#include "simulation/families/hinges/hinges.h"
#include "simulation/families/membranes/membranes.h"
#include "simulation/families/springs/springs.h"
#include "simulation/families/tetrahedra/tetrahedra.h"
#include "simulation/model/model.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {
namespace {

const std::string kScene = R"(
[scene]
frames = 1
dt = 0.01
[[cloth]]
name = "film"
grid = { size = [1.0, 0.5], resolution = [6, 4] }
translate = [0.0, 0.25, 0.0]
density = 0.2
membrane = { young = 1.0e4, poisson = 0.3, thickness = 1.0e-2 }
[[solid]]
name = "brick"
grid = { size = [1.0, 0.5, 0.5], resolution = [6, 4, 4] }
rotate = [0.0, 1.0, 0.0, 180.0]
density = 800.0
young = 1.0e5
poisson = 0.25
[[attachment]]
a = "film"
b = "brick"
corners = ["x-z-", "x+z+"]
stiffness = 30.0
)";

struct Built {
    explicit Built(const Scene& scene) : model(scene, warnings) {}
    explicit Built(const std::string& text = kScene) : Built(parse_scene(text, "test.toml")) {}
    Warnings warnings;
    Model model;
};

/// All positions under one linear map.
std::vector<float4> mapped(const Model& model, const Mat3& map) {
    std::vector<float4> x;
    for (const float4& p : model.positions->span()) x.push_back(to_float4(map * to_vec3(p)));
    return x;
}

TEST(SolidModel, HasCorrectMassesAndOrder) {
    const Built built;
    const Model& model = built.model;
    double film = 0.0;
    double brick = 0.0;
    for (std::size_t v = 0; v < model.masses.size(); ++v) {
        (model.strips.order[v] < 24 ? film : brick) += model.masses[v];
    }
    EXPECT_NEAR(film, 0.2 * 0.5, 1e-12);
    EXPECT_NEAR(brick, 800.0 * 0.25, 1e-9);
    ASSERT_EQ(model.bodies.size(), 2U);
    EXPECT_EQ(model.bodies[1].kind, "solid");
    EXPECT_EQ(model.bodies[1].first_vertex, 24);
    EXPECT_EQ(model.bodies[1].vertex_count, 96);
}

TEST(SolidModel, ShowsItsSurface) {
    const Built built;
    std::size_t of_film = 0;
    for (std::size_t t = 0; t < built.model.triangles.size(); ++t) {
        const bool is_film = built.model.body_of_triangle(static_cast<int>(t)) == 0;
        of_film += is_film ? 1 : 0;
        for (const int v : built.model.triangles[t]) EXPECT_EQ(v < 24, is_film);
    }
    EXPECT_EQ(of_film, 2U * 5 * 3);
    EXPECT_EQ(built.model.triangles.size() - of_film, 4U * (5 * 3 + 5 * 3 + 3 * 3));
}

/// Uniform deformation: V (mu/2 (|F|^2 - 3) - mu (J - 1) + lambda/2 (J - 1)^2).
TEST(SolidModel, EnergyOfAUniformDeformationIsThatOfTheMaterial) {
    const Built built;
    const double mu = 1e5 / 2.5;
    const double lambda = mu + 2.0 * mu * 0.25 / 0.5;  // Lame's lambda, and mu
    const Mat3 map{{Vec3{1.2, 0.1, 0.0}, Vec3{-0.1, 0.9, 0.2}, Vec3{0.0, 0.0, 0.8}}};
    double norm = 0.0;
    for (const Vec3& row : map.rows) norm += dot(row, row);
    const double J = dot(map.rows[0], cross(map.rows[1], map.rows[2]));
    const double expected =
        0.25 * (0.5 * mu * (norm - 3.0) - mu * (J - 1.0) + 0.5 * lambda * (J - 1.0) * (J - 1.0));
    const auto x = mapped(built.model, map);
    EXPECT_NEAR(built.model.find<Tetrahedra>()->total_energy(x), expected, 1e-5 * expected);
    EXPECT_LT(built.model.find<Tetrahedra>()->total_energy(built.model.positions->span()),
              1e-6 * expected);
}

TEST(MembraneModel, EnergyOfAUniformDeformationIsThatOfTheMaterial) {
    const Built built;
    const double mu = 1e4 * 1e-2 / 2.6;
    const double lambda = mu * 1.3 / 0.7;
    const Mat3 map{{Vec3{1.2, 0.0, 0.1}, Vec3{0.3, 1.0, 0.2}, Vec3{0.0, 0.0, 0.8}}};
    const Vec3 u{1.2, 0.3, 0.0};  // images of the sheet's axes x and z
    const Vec3 v{0.1, 0.2, 0.8};
    const double norm = dot(u, u) + dot(v, v);
    const double J = length(cross(u, v));
    const double expected =
        0.5 * (0.5 * mu * (norm - 2.0) - mu * (J - 1.0) + 0.5 * lambda * (J - 1.0) * (J - 1.0));
    const auto x = mapped(built.model, map);
    EXPECT_NEAR(built.model.find<Membranes>()->total_energy(x), expected, 1e-5 * expected);
}

TEST(AttachmentModel, TiesSelectedVerticesToTheNearestOnes) {
    const Built built;
    const Springs& springs = *built.model.find<Springs>();
    ASSERT_EQ(springs.elements().count(), 2) << "a membrane needs no springs";
    for (int s = 0; s < 2; ++s) {
        EXPECT_FALSE(springs.is_edge(s));
        EXPECT_NEAR(springs.rest_length(s), 0.0, 1e-12);
        EXPECT_NEAR(springs.stiffness(s), 30.0, 1e-5);
        const auto ends = springs.elements().vertices_of(s);
        const Vec3 a = to_vec3((*built.model.positions)[static_cast<std::size_t>(ends[0])]);
        const Vec3 b = to_vec3((*built.model.positions)[static_cast<std::size_t>(ends[1])]);
        EXPECT_LT(length(a - b), 1e-6);
        EXPECT_NEAR(std::abs(a.x), 0.5, 1e-6);
        EXPECT_NEAR(std::abs(a.z), 0.25, 1e-6);
    }
}

TEST(AttachmentModel, IsLimitedByItsReach) {
    Scene scene = parse_scene(kScene, "test.toml");
    scene.cloths[0].transform.translate = {0.15, 0.45, 0.0};
    Attachment& attachment = scene.attachments[0];
    attachment.selected.corners = {"x-z-", "x+z-"};
    attachment.reach = 0.2;  // it lies 0.2 above, and no vertex is straight below
    EXPECT_THROW(Built{scene}, UserError);
    attachment.reach = 0.21;
    EXPECT_EQ(Built(scene).model.find<Springs>()->elements().count(), 1);
    EXPECT_NEAR(Built(scene).model.find<Springs>()->rest_length(0), std::hypot(0.2, 0.05), 1e-6);
    attachment.reach = 0.251;
    EXPECT_EQ(Built(scene).model.find<Springs>()->elements().count(), 2);
}

TEST(AttachmentModel, FindsTheNearestOfAllVertices) {
    Scene scene = parse_scene(kScene, "test.toml");
    scene.cloths[0].transform.rotations = {{{1.0, 2.0, 0.5}, 37.0}};
    scene.attachments[0].selected.corners.clear();
    for (int v = 0; v < 24; ++v) scene.attachments[0].selected.vertices.push_back(v);
    const Built built(scene);
    const Model& model = built.model;
    ASSERT_EQ(model.find<Springs>()->elements().count(), 24);
    for (int s = 0; s < 24; ++s) {
        const auto ends = model.find<Springs>()->elements().vertices_of(s);
        double least = 1e9;
        for (std::size_t v = 0; v < model.positions->count(); ++v) {
            if (model.strips.order[v] < 24) continue;
            const Vec3 way = to_vec3((*model.positions)[v]) -
                             to_vec3((*model.positions)[static_cast<std::size_t>(ends[0])]);
            least = std::min(least, length(way));
        }
        EXPECT_NEAR(model.find<Springs>()->rest_length(s), least, 1e-6);
    }
}

TEST(SolidModel, HasNothingThatTheSceneDoesNotName) {
    Scene scene = parse_scene(kScene, "test.toml");
    scene.cloths.clear();
    scene.attachments.clear();
    const Built solid(scene);
    EXPECT_NE(solid.model.find<Tetrahedra>(), nullptr);
    EXPECT_EQ(solid.model.find<Springs>(), nullptr);
    EXPECT_EQ(solid.model.find<Membranes>(), nullptr);
    EXPECT_EQ(solid.model.find<Hinges>(), nullptr);
}

}  // namespace
}  // namespace weft::test
