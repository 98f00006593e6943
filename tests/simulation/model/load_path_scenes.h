#pragma once

#include <string>

/// Scenes whose weight has a way to go to where it is borne.
namespace weft::test {

inline const std::string kSheet = R"(
[scene]
frames = 1
dt = 0.016666667
[[cloth]]
name = "sheet"
grid = { size = [1.0, 2.0], resolution = [11, 21] }
density = 0.2
stretch = { stiffness = 1.0e3 }
)";
inline const std::string kPins = "pins = { box = [[-1.0, -1.0, -1.001], [1.0, 1.0, -0.999]] }\n";
inline const std::string kBlock = R"(
[[solid]]
name = "block"
grid = { size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }
translate = [0.0, -0.1, 0.0]
density = 1000.0
young = 1.0e5
poisson = 0.3
)";
inline const std::string kTies = R"(
[[attachment]]
a = "block"
b = "sheet"
faces = ["y+"]
stiffness = 100.0
)";

/// 1 m from its pins on, by edges of 0.1 m and diagonals.
inline const std::string kBeam = R"(
[scene]
frames = 1
dt = 0.02
[[solid]]
grid = { size = [1.0, 0.1, 0.1], resolution = [11, 2, 2] }
density = 20.0
young = 1.0e6
poisson = 0.3
)";
inline const std::string kStrip = R"(
[scene]
frames = 1
dt = 0.02
[[cloth]]
name = "strip"
grid = { size = [1.0, 0.2], resolution = [21, 5] }
density = 0.1
stretch = { stiffness = 1.0e4 }
bend = { stiffness = 1.0 }
pins = { box = [[-1.0, -1.0, -1.0], [-0.449, 1.0, 1.0]] }
)";

}  // namespace weft::test
