#pragma once

#include <string>

namespace weft::test {

/// Everything that a scene can have, small: cloths of different stiffness with and without bending,
/// damping, fixed and moving pins, four obstacles with and without friction that all touch cloth.
/// Nothing in it needs more than + - * / and square roots, so it is the same on every machine.
inline const std::string kEverything = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
name = "sheet"
grid = { size = [0.8, 2.0], resolution = [9, 40] }
translate = [0.0, 0.62, 0.0]
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-3 }
damping = 0.5
[[cloth.pins]]
corners = ["x-z-"]
[[cloth.pins]]
corners = ["x+z-"]
motion = { velocity = [0.5, 1.0, -0.5] }

[[cloth]]
name = "band"
grid = { size = [0.3, 1.5], resolution = [6, 33] }
translate = [1.0, 0.62, 0.0]
density = 0.4
stretch = { stiffness = 2.0e2 }
pins = { vertices = [0, 100] }

[[cloth]]
name = "scrap"
grid = { size = [0.2, 0.2], resolution = [4, 4] }
translate = [2.0, 0.301, 0.0]
density = 0.1
stretch = { stiffness = 1.0e3 }

[[obstacle]]
shape = "sphere"
center = [0.0, 0.5, -0.5]
radius = 0.15
friction = 0.4
motion = { velocity = [0.5, 0.2, 0.0] }

[[obstacle]]
shape = "plane"
point = [0.0, 0.3, 0.0]
friction = 0.2

[[obstacle]]
shape = "capsule"
start = [0.0, 0.35, 0.4]
end = [0.0, 0.55, 0.4]
radius = 0.1
thickness = 0.01

[[obstacle]]
shape = "box"
center = [1.0, 0.5, 0.3]
size = [0.2, 0.3, 0.2]
motion = { velocity = [0.0, 0.5, 0.0] }
)";

/// Springs alone.
inline const std::string kSpringsOnly = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
grid = { size = [0.5, 2.0], resolution = [8, 60] }
density = 0.2
stretch = { stiffness = 1.0e4 }
pins = { corners = ["x-z-"] }
)";

}  // namespace weft::test
