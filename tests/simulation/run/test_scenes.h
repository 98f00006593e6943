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

/// Solids, triangle membranes beside springs and bending, attachments between cloth and solid and
/// between two solids, fixed and moving pins, damping, friction.
inline const std::string kSolids = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
name = "sheet"
grid = { size = [0.9, 1.5], resolution = [9, 30] }
translate = [0.0, 0.6, 0.85]
density = 0.2
membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }
bend = { stiffness = 1.0e-3 }

[[cloth]]
name = "net"
grid = { size = [0.3, 1.5], resolution = [5, 24] }
translate = [1.0, 0.62, 0.0]
density = 0.4
stretch = { stiffness = 2.0e2 }
membrane = { young = 1.0e5, poisson = 0.0, thickness = 1.0e-3 }
damping = 0.3
pins = { vertices = [0, 100] }

[[solid]]
name = "beam"
grid = { size = [0.3, 0.2, 2.0], resolution = [4, 3, 36] }
translate = [0.0, 0.5, -0.9]
density = 1000.0
young = 2.0e5
poisson = 0.4
damping = 0.5
[[solid.pins]]
faces = ["z-"]
motion = { velocity = [0.5, 0.2, -0.5] }
[[solid.pins]]
corners = ["x-y-z+"]

[[solid]]
name = "weight"
grid = { size = [0.3, 0.3, 0.3], resolution = [4, 4, 4] }
translate = [0.0, 0.2, 0.1]
density = 500.0
young = 1.0e5
poisson = -0.2

[[attachment]]
a = "sheet"
b = "beam"
box = [[-0.2, 0.0, 0.0], [0.2, 1.0, 0.2]]
stiffness = 2.0e3
[[attachment]]
a = "weight"
b = "beam"
faces = ["y+"]
stiffness = 1.0e4
reach = 0.3

[[obstacle]]
shape = "plane"
point = [0.0, 0.05, 0.0]
friction = 0.3

[[obstacle]]
shape = "sphere"
center = [0.05, 0.3, -0.6]
radius = 0.12
friction = 0.4
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
