#include "apps/weft/studies/stability/contact_cases.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/weft/studies/stability/case_text.h"

namespace weft::stability {

namespace {

const Bound kNoneCross{Quantity::kCrossings, 0.0, 0.0};

/// A block of 0.2 m on one twice as wide, which is held at its floor. The material is as stiff as
/// the load asks for: 2 % at most. Without friction, so it may slide while both still swing.
void add_columns(std::vector<Case>& cases) {
    for (const double ratio : {1e-4, 1e-2, 1e0, 1e2, 1e4}) {
        for (const Steps& steps : {kSteps[1], kSteps[2], kSteps[3], kSteps[4]}) {
            Case c;
            c.group = "contact";
            c.name = fmt::format("upper : lower = {:.0e}, {}", ratio, step_text(steps));
            c.scene = head(steps, 0.5) + fmt::format(R"([contact]
thickness = 0.01
[[solid]]
name = "lower"
grid = {{ size = [0.4, 0.2, 0.4], resolution = [5, 3, 5] }}
density = {0:.6g}
young = {2:.6g}
poisson = 0.3
pins = {{ faces = ["y-"] }}
[[solid]]
name = "upper"
grid = {{ size = [0.2, 0.2, 0.2], resolution = [3, 3, 3] }}
translate = [0.01, 0.21, 0.02]
rotate = [0.0, 1.0, 0.0, 5.0]
density = {1:.6g}
young = {2:.6g}
poisson = 0.3
)",
                                                     1e3 / std::sqrt(ratio), 1e3 * std::sqrt(ratio),
                                                     1e5 * std::sqrt(std::max(ratio, 1.0 / ratio)));
            c.criterion = {kNoneCross,
                           {Quantity::kStrain, 0.0, 0.05},
                           {Quantity::kRise, -0.02, 0.005},
                           {Quantity::kDrift, 0.0, 0.1}};
            c.across = 1e3 * steps.length();
            c.up = ratio;
            c.in_short = steps.substeps == 4 && ratio > 1e-3 && ratio < 1e3;
            cases.push_back(c);
        }
    }
}

Case single(const std::string& name, const std::string& scene, std::vector<Bound> criterion) {
    Case c;
    c.group = "touching";
    c.name = name;
    c.scene = scene;
    c.criterion = std::move(criterion);
    return c;
}

/// A sheet that is led by its borders goes up against a loose one, and takes it along. Waves in it
/// travel at 70 m/s: what is led faster stretches it.
void add_meetings(std::vector<Case>& cases) {
    for (const double speed : {1.0, 10.0, 100.0}) {
        const double time = 0.2 / speed;
        Case c = single(
            fmt::format("sheets meet at {:g} m/s", speed),
            head({time / 12, 4}, time, "gravity = [0.0, 0.0, 0.0]") + fmt::format(R"([contact]
thickness = 0.005
[guard]
max_speed = 1.0e5
[[cloth]]
name = "led"
grid = {{ size = [0.4, 0.4], resolution = [9, 9] }}
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
[[cloth.pins]]
edges = ["x-", "x+", "z-", "z+"]
motion = {{ velocity = [0.0, {0:g}, 0.0] }}
[[cloth]]
name = "loose"
grid = {{ size = [0.3, 0.3], resolution = [8, 8] }}
translate = [0.0, 0.05, 0.0]
rotate = [0.0, 1.0, 0.0, 20.0]
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
)",
                                                                                  speed),
            {kNoneCross,
             {Quantity::kStrain, 0.0, speed < 50.0 ? 0.5 : 2.0},
             {Quantity::kRise, 0.05, 1.0}});
        c.in_short = speed == 10.0;
        cases.push_back(c);
    }
}

void add_piles(std::vector<Case>& cases) {
    std::string pile = head({1.0 / 60, 8}, 2.0) + R"([contact]
thickness = 0.01
friction = 0.3
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.3
)";
    for (int sheet = 0; sheet < 5; ++sheet) {
        pile += fmt::format(R"([[cloth]]
grid = {{ size = [0.3, 0.3], resolution = [7, 7] }}
translate = [{0:g}, {1:g}, 0.0]
rotate = [0.0, 1.0, 0.0, {2}]
density = 0.2
stretch = {{ stiffness = 1.0e3 }}
bend = {{ stiffness = 1.0e-4 }}
)",
                            0.005 * sheet, 0.01 * (sheet + 1), 7 * sheet);
    }
    cases.push_back(
        single("five sheets lie on each other", pile,
               {kNoneCross, {Quantity::kDrift, 0.0, 0.01}, {Quantity::kStrain, 0.0, 0.02}}));
    cases.push_back(
        single("a heavy block falls on a light sheet", head(kUsual, 0.5) + R"([contact]
thickness = 0.01
[[cloth]]
grid = { size = [1.0, 1.0], resolution = [12, 12] }
density = 0.1
stretch = { stiffness = 1.0e5 }
pins = { edges = ["z-", "z+"] }
[[solid]]
grid = { size = [0.3, 0.3, 0.3], resolution = [4, 4, 4] }
translate = [0.0, 0.2, 0.0]
density = 3000.0
young = 1.0e6
poisson = 0.3
)",
               {kNoneCross, {Quantity::kStrain, 0.0, 0.1}, {Quantity::kRise, -0.5, 0.1}}));
}

}  // namespace

void add_contacts(std::vector<Case>& cases) {
    add_columns(cases);
    add_meetings(cases);
    add_piles(cases);
}

}  // namespace weft::stability
