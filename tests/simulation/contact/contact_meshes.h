#pragma once

#include <string>
#include <vector>

#include "simulation/contact/surface.h"
#include "tests/kernels/random.h"

namespace weft::test {

/// A surface to find pairs on, and where its vertices are.
struct ContactMesh {
    std::string name;
    SurfaceMesh mesh;  ///< in the strips' order of vertices
    Strips strips;
    std::vector<float4> anchors;  ///< [vertices] xyz, w = reach
    float thickness = 0.0f;
    bool self = true;
};

/// Random, folded, degenerate ones, stacks, a fan, and sheets that are flat.
std::vector<ContactMesh> contact_meshes();
/// A sheet that cannot fold in a substep.
ContactMesh flat_sheet(int size);
/// Layers above each other.
ContactMesh stack(int layers, int size, float gap, float thickness, float reach);

}  // namespace weft::test
