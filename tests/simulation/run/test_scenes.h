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

/// Tubes that are curved at rest, one of them with a membrane, sewn together at their rims and to a
/// flat panel; a seam that closes within the run and one that does not.
inline const std::string kSewn = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
name = "upper"
cylinder = { radius = [0.2, 0.25], height = 0.9, resolution = [12, 24] }
translate = [0.0, 1.2, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-2 }
[[cloth.pins]]
rims = ["top"]
motion = { velocity = [0.5, 0.2, 0.0] }

[[cloth]]
name = "lower"
cylinder = { radius = [0.27, 0.3], height = 0.9, resolution = [16, 24] }
translate = [0.0, 0.44, 0.0]
density = 0.3
membrane = { young = 1.0e5, poisson = 0.3, thickness = 1.0e-3 }
bend = { stiffness = 1.0e-2 }
damping = 0.5

[[cloth]]
name = "panel"
grid = { size = [0.3, 0.9], resolution = [5, 24] }
translate = [0.0, 0.3, 0.6]
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }

[[seam]]
a = { cloth = "upper", rims = ["bottom"] }
b = { cloth = "lower", rims = ["top"] }
stiffness = 5.0e2
time = 0.05
[[seam]]
a = { cloth = "panel", vertices = [0, 4, 2] }
b = { cloth = "lower", vertices = [370, 373, 380] }
stiffness = 5.0e1
time = 0.5

[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.2

[[obstacle]]
shape = "sphere"
center = [0.0, 0.25, 0.6]
radius = 0.1
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

/// Woven cloth across its threads, with bending, held and moved, on a ball.
inline const std::string kWoven = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
grid = { size = [0.5, 2.4], resolution = [8, 64] }
translate = [0.0, 0.62, 0.0]
density = 0.2
woven = { warp = 2.0e3, weft = 4.0e2, shear = 30.0, direction = [1.0, 0.0, 2.0] }
bend = { stiffness = 1.0e-3 }
damping = 0.5
[[cloth.pins]]
corners = ["x-z-"]
[[cloth.pins]]
corners = ["x+z-"]
motion = { velocity = [0.5, 1.0, -0.5] }

[[obstacle]]
shape = "sphere"
center = [0.0, 0.5, 0.2]
radius = 0.15
friction = 0.4
)";

/// Cloth and solids on obstacles that pass between their vertices: a line, a bar that moves, a
/// small ball that is fast.
inline const std::string kNarrow = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
[solver]
iterations = 3

[[cloth]]
name = "sheet"
grid = { size = [0.8, 2.0], resolution = [9, 40] }
translate = [0.0, 0.5, 0.0]
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
damping = 0.5
pins = { corners = ["x-z-", "x+z-"] }

[[solid]]
grid = { size = [0.3, 0.3, 0.3], resolution = [4, 4, 4] }
translate = [1.0, 0.67, 0.0]
density = 200.0
young = 1.0e5
poisson = 0.3

[[obstacle]]
shape = "capsule"
start = [-0.5, 0.49, 0.1]
end = [1.5, 0.49, 0.1]
radius = 0.006
friction = 0.4

[[obstacle]]
shape = "box"
center = [0.0, 0.44, -0.5]
size = [0.9, 0.02, 0.03]
motion = { velocity = [0.0, 1.0, 0.2] }

[[obstacle]]
shape = "sphere"
center = [0.05, 1.0, 0.62]
radius = 0.02
thickness = 0.002
motion = { velocity = [0.0, -9.0, 0.0] }
)";
inline const std::string kNarrowTouching = kNarrow + "[contact]\nthickness = 0.004\n";

/// A block on a sheet on a net whose one side is carried along, all in contact from the start.
inline const std::string kTouching = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4

[solver]
iterations = 5

[contact]
thickness = 0.01

[[cloth]]
name = "net"
grid = { size = [0.6, 1.2], resolution = [15, 30] }
density = 0.2
stretch = { stiffness = 300.0 }
bend = { stiffness = 1.0e-4 }

[[cloth.pins]]
edges = ["x-"]
[[cloth.pins]]
edges = ["x+"]
[cloth.pins.motion]
velocity = [-0.5, 0.2, 0.0]

[[cloth]]
name = "sheet"
grid = { size = [0.3, 0.3], resolution = [10, 10] }
rotate = [0, 1, 0, 20]
translate = [0.0, 0.012, 0.0]
density = 0.2
stretch = { stiffness = 300.0 }
damping = 0.1

[[solid]]
name = "block"
grid = { size = [0.1, 0.1, 0.1], resolution = [3, 3, 3] }
translate = [0.02, 0.075, 0.01]
density = 500.0
young = 2.0e4
poisson = 0.3
)";

/// The same with friction, and two sheets that fall beside it, one over the other, faster in the
/// end than they are apart.
inline const std::string kRubbing = [] {
    std::string text = kTouching + R"(
[[cloth]]
name = "low"
grid = { size = [0.3, 0.3], resolution = [8, 8] }
translate = [1.0, 0.0, 0.0]
density = 0.2
stretch = { stiffness = 300.0 }

[[cloth]]
name = "high"
grid = { size = [0.3, 0.3], resolution = [8, 8] }
rotate = [0, 1, 0, 20]
translate = [1.0, 0.003, 0.0]
density = 0.2
stretch = { stiffness = 300.0 }
)";
    const std::string before = "thickness = 0.01\n";
    text.insert(text.find(before) + before.size(), "friction = 0.4\n");
    return text;
}();

/// The same without the block.
inline const std::string kSheets = [] {
    std::string text = kRubbing;
    const std::size_t block = text.find("[[solid]]");
    return text.erase(block, text.find("[[cloth]]", block) - block);
}();

/// What friction holds of solids while obstacles push them, of one that tips over, and of a sheet.
inline const std::string kLying = R"(
[scene]
frames = 4
dt = 0.02
substeps = 4
gravity = [2.0, -9.6, 0.0]

[solver]
iterations = 5

[[solid]]
name = "low"
grid = { size = [0.3, 0.1, 0.2], resolution = [8, 4, 6] }
rotate = [0, 1, 0, 17]
translate = [0.0, 0.051, 0.0]
density = 500.0
young = 1.0e6
poisson = 0.3

[[solid]]
name = "tall"
grid = { size = [0.1, 0.5, 0.1], resolution = [4, 11, 4] }
rotate = [0, 0, 1, 5]
translate = [0.5, 0.255, 0.1]
density = 500.0
young = 1.0e6
poisson = 0.3

[[cloth]]
name = "sheet"
grid = { size = [0.3, 0.3], resolution = [12, 12] }
translate = [-0.5, 0.001, 0.0]
density = 0.2
stretch = { stiffness = 300.0 }

[[obstacle]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.4
thickness = 0.002

[[obstacle]]
name = "ledge"
shape = "box"
center = [0.6, 0.0, 0.1]
size = [0.1, 0.02, 0.4]
thickness = 0.002
)";

}  // namespace weft::test
