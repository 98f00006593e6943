#pragma once

#include <string>

namespace weft::test {

/// Two sheets, a little askew, `gap` [m] from each other, so that they press each other where
/// contacts begin at 20 mm; the lower one hangs at two sides. Behind a scene's tables, or between
/// them.
inline std::string touching_sheets(const std::string& gap) {
    return R"(
[[cloth]]
name = "low"
grid = { size = [0.5, 0.5], resolution = [9, 9] }
density = 0.2
stretch = { stiffness = 300.0 }
pins = { edges = ["x-", "x+"] }
[[cloth]]
name = "high"
grid = { size = [0.3, 0.3], resolution = [7, 7] }
rotate = [0, 1, 0, 20]
translate = [0.01, )" +
           gap + R"(, 0.02]
density = 0.2
stretch = { stiffness = 300.0 }
)";
}
inline const std::string kTouchingSheets = touching_sheets("0.016");

}  // namespace weft::test
