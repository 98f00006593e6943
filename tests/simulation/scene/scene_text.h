#pragma once

#include <string>

namespace weft::test {

/// A scene that uses every part of the format; tests break one thing in it at a time.
inline const std::string kFullScene = R"([scene]
name = "full"
frames = 3
dt = 0.02
substeps = 2
gravity = [0.0, -9.81, 0.0]

[solver]
method = "xpbd"
iterations = 4

[guard]
max_speed = 500.0

[[cloth]]
name = "sheet"
grid = { size = [1.0, 2.0], resolution = [5, 9] }
scale = 0.5
rotate = [0.0, 0.0, 1.0, 90.0]
translate = [0.0, 1.0, 0.0]
density = 0.2
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0e-4 }
damping = 0.5
pins = { corners = ["x-z-", "x+z-"] }

[[cloth]]
name = "tube"
cylinder = { radius = [0.2, 0.4], height = 0.5, resolution = [8, 4] }
density = 0.3
stretch = { stiffness = 2.0e4 }
[[cloth.pins]]
rims = ["top"]
motion = { keyframes = [{ time = 0.0 }, { time = 1.0, translate = [0.0, 1.0, 0.0] }] }
[[cloth.pins]]
vertices = [30]

[[solid]]
name = "brick"
grid = { size = [0.3, 0.2, 0.1], resolution = [4, 3, 2] }
translate = [0.0, 2.0, 0.0]
density = 1000.0
young = 1.0e5
poisson = 0.45
damping = 0.25
pins = { faces = ["x-"], corners = ["x+y+z+"] }

[[cloth]]
name = "film"
grid = { size = [0.3, 0.2], resolution = [4, 3] }
density = 0.1
membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }

[[attachment]]
a = "film"
b = "brick"
corners = ["x-z-"]
stiffness = 500.0
reach = 3.0

[[obstacle]]
name = "ball"
shape = "sphere"
center = [0.0, 0.5, 0.0]
radius = 0.3
friction = 0.4
motion = { velocity = [1.0, 0.0, 0.0] }

[[obstacle]]
shape = "plane"
point = [0.0, -1.0, 0.0]

[[obstacle]]
shape = "capsule"
start = [0.0, 0.0, 0.0]
end = [2.0, 0.0, 0.0]
radius = 0.1

[[obstacle]]
shape = "box"
center = [0.0, 0.0, 3.0]
size = [1.0, 2.0, 4.0]
thickness = 0.01
)";

/// The least that a scene must say.
inline const std::string kSmallScene = R"([scene]
frames = 2
dt = 0.01

[[cloth]]
grid = { size = [1.0, 1.0], resolution = [3, 3] }
density = 0.2
stretch = { stiffness = 100.0 }
)";

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("test text has no '" + from + "'");
    return text.replace(at, from.size(), to);
}

}  // namespace weft::test
