// The scenes that ship: valid, small enough for CI as they are, and a million vertices on request.
#include <filesystem>

#include <gtest/gtest.h>

#include "simulation/bodies/cloth_mesh.h"
#include "simulation/bodies/solid_mesh.h"
#include "simulation/scene/read_scene.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

int vertices_of(const Scene& scene) {
    int vertices = 0;
    Warnings warnings;
    for (const Cloth& cloth : scene.cloths) {
        const TriangleMesh mesh = build_cloth_mesh(cloth, warnings);
        for (const PinGroup& pins : cloth.pins) {
            EXPECT_FALSE(pinned_vertices(cloth, pins, mesh).empty());
        }
        vertices += mesh.vertex_count();
    }
    for (const Solid& solid : scene.solids) {
        const TetMesh mesh = build_solid_mesh(solid, warnings);
        for (const PinGroup& pins : solid.pins) {
            EXPECT_FALSE(pinned_vertices(solid, pins, mesh).empty());
        }
        vertices += mesh.vertex_count();
    }
    EXPECT_TRUE(warnings.empty());
    return vertices;
}

TEST(ShippedScenes, AreSmallAndGrowToAMillionVertices) {
    int scenes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(WEFT_SCENES)) {
        if (entry.path().extension() != ".toml") continue;
        SCOPED_TRACE(entry.path().string());
        ++scenes;
        EXPECT_LE(vertices_of(read_scene(entry.path().string())), 64 * 64);
        const Scene large = read_scene(entry.path().string(), {{"scene.size=1000000", "--set"}});
        // Whole numbers of vertices along three axes leave fewer choices than along two.
        EXPECT_NEAR(vertices_of(large), 1000000, large.solids.empty() ? 10000 : 40000);
    }
    EXPECT_GE(scenes, 5);
}

}  // namespace
}  // namespace weft
