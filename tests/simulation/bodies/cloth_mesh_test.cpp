#include "simulation/bodies/cloth_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/error.h"

namespace weft {
namespace {

Cloth grid_cloth() {
    Cloth cloth;
    cloth.name = "sheet";
    cloth.shape = GridShape{{2.0, 1.0}, {5, 3}};
    return cloth;
}

TriangleMesh mesh_of(const Cloth& cloth) {
    Warnings warnings;
    TriangleMesh mesh = build_cloth_mesh(cloth, warnings);
    EXPECT_TRUE(warnings.empty());
    return mesh;
}

TEST(ClothMesh, ScalesThenRotatesThenTranslates) {
    Cloth cloth = grid_cloth();
    cloth.transform = {{2, 1, 1}, {{{0, 0, 1}, 90}, {{0, 1, 0}, 90}}, {0, 0, 5}};
    const TriangleMesh mesh = mesh_of(cloth);
    // (1, 0, 0.5) -> (2, 0, 0.5) -> about z: (0, 2, 0.5) -> about y: (0.5, 2, 0) -> + (0, 0, 5)
    EXPECT_LT(length(mesh.positions.back() - Vec3{0.5, 2, 5}), 1e-12);
}

TEST(ClothMesh, PinsByCornerIndexAndBox) {
    const Cloth cloth = grid_cloth();
    const TriangleMesh mesh = mesh_of(cloth);
    PinGroup pins;
    pins.corners = {"x-z-", "x+z-", "x-z+", "x+z+"};
    EXPECT_EQ(pinned_vertices(cloth, pins, mesh), (std::vector{0, 4, 10, 14}));
    pins.corners = {"x+z-"};
    EXPECT_EQ(mesh.positions[4], (Vec3{1.0, 0.0, -0.5}));
    pins.vertices = {7, 4, 7};
    pins.boxes = {{{-1, -1, -1}, {-1, 1, 1}}};
    EXPECT_EQ(pinned_vertices(cloth, pins, mesh), (std::vector{0, 4, 5, 7, 10}));
}

TEST(ClothMesh, PinsRims) {
    Cloth cloth;
    cloth.shape = CylinderShape{{1, 1}, 1, {3, 2}};
    PinGroup pins;
    pins.rims = {"bottom"};
    EXPECT_EQ(pinned_vertices(cloth, pins, mesh_of(cloth)), (std::vector{3, 4, 5}));
}

TEST(ClothMesh, PinsByNamedPart) {
    TriangleMesh mesh = mesh_of(grid_cloth());
    mesh.parts = {{"left", 0, 1, "shirt"}, {"right", 1, mesh.triangle_count() - 1, "shirt"}};
    Cloth cloth;
    cloth.shape = MeshFile{"shirt.obj"};
    PinGroup pins;
    pins.where = "s.toml:7:1";
    pins.parts = {"left"};
    std::vector<int> first(mesh.triangles[0].begin(), mesh.triangles[0].end());
    std::sort(first.begin(), first.end());
    EXPECT_EQ(pinned_vertices(cloth, pins, mesh), first);
    pins.parts = {"lefd"};
    try {
        pinned_vertices(cloth, pins, mesh);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_STREQ(error.what(),
                     "s.toml:7:1: pins of cloth '': parts = 'lefd': the mesh has no such part; did "
                     "you mean 'left'?");
    }
}

TEST(ClothMesh, RefusesPinsThatNameNothing) {
    const Cloth cloth = grid_cloth();
    const TriangleMesh mesh = mesh_of(cloth);
    PinGroup pins;
    pins.where = "s.toml:7:1";
    pins.vertices = {15};
    try {
        pinned_vertices(cloth, pins, mesh);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_STREQ(error.what(),
                     "s.toml:7:1: pins of cloth 'sheet': vertex 15 is out of range: "
                     "the mesh has 15 vertices, counted from 0");
    }
    pins.vertices = {};
    pins.boxes = {{{5, 5, 5}, {6, 6, 6}}};
    EXPECT_THROW(pinned_vertices(cloth, pins, mesh), UserError);
}

TEST(ClothMesh, RefusesWhatVanishesInSinglePrecision) {
    Cloth cloth = grid_cloth();
    cloth.shape = GridShape{{1e-5, 1e-5}, {5, 3}};
    cloth.transform.translate = {1e4, 0, 0};
    Warnings warnings;
    EXPECT_THROW(build_cloth_mesh(cloth, warnings), UserError);
}

TEST(ClothMesh, MissingMeshFile) {
    Cloth cloth;
    cloth.shape = MeshFile{"no/such.obj"};
    Warnings warnings;
    EXPECT_THROW(build_cloth_mesh(cloth, warnings), UserError);
}

}  // namespace
}  // namespace weft
