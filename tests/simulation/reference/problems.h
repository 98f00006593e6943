#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "simulation/mesh/vec3.h"
#include "simulation/scene/read_scene.h"

namespace weft::test {

/// One step of 0.01 s of a small sheet that hangs from a fixed and a moving pin.
inline const std::string kPinnedSheet = R"(
[scene]
frames = 1
dt = 0.04
substeps = 4
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [7, 8] }
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-2 }
[[cloth.pins]]
corners = ["x-z-"]
[[cloth.pins]]
corners = ["x+z-"]
motion = { velocity = [1.0, 0.0, 0.0] }
)";

/// A block that hangs from a corner, and a membrane that is tied to it.
inline const std::string kPinnedBlock = R"(
[scene]
frames = 1
dt = 0.04
substeps = 4
[[cloth]]
name = "film"
grid = { size = [0.6, 0.6], resolution = [4, 4] }
translate = [0.0, 0.3, 0.0]
density = 0.2
membrane = { young = 1.0e5, poisson = 0.3, thickness = 1.0e-3 }
[[solid]]
name = "block"
grid = { size = [0.6, 0.6, 0.6], resolution = [4, 4, 3] }
density = 500.0
young = 1.0e4
poisson = 0.4
pins = { corners = ["x-y+z-"] }
[[attachment]]
a = "film"
b = "block"
corners = ["x+z-", "x-z+"]
stiffness = 1.0e3
)";

/// Woven cloth that hangs from a corner, its threads along neither side.
inline const std::string kPinnedWeave = R"(
[scene]
frames = 1
dt = 0.04
substeps = 4
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [7, 8] }
density = 0.2
woven = { warp = 1.0e3, weft = 3.0e2, shear = 50.0, direction = [1.0, 0.0, 0.4] }
bend = { stiffness = 1.0e-2 }
pins = { corners = ["x-z-"] }
)";

/// x with every coordinate moved by up to `size` [m], the same with every standard library.
inline std::vector<Vec3> shaken(std::vector<Vec3> x, double size, unsigned seed) {
    std::mt19937 engine(seed);
    const auto random = [&] {
        return size * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1.0);
    };
    for (Vec3& v : x) {
        v.x += random();
        v.y += random();
        v.z += random();
    }
    return x;
}

}  // namespace weft::test
