#include "apps/weft/studies/stability/cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "apps/weft/studies/stability/case_text.h"
#include "apps/weft/studies/stability/contact_cases.h"

namespace weft::stability {

namespace {

// ---- maps ----

/// A sheet of 1 m and 0.2 kg that is held along one edge falls into its pins. At rest each spring
/// is stretched by 2 / stiffness at most.
void add_stiffness(std::vector<Case>& cases) {
    for (const double stiffness : {1e0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12}) {
        for (const Steps& steps : kSteps) {
            Case c;
            c.group = "stiffness";
            c.name = fmt::format("k = {:.0e} N/m, {}", stiffness, step_text(steps));
            c.scene = head(steps, 0.5) + fmt::format(R"([[cloth]]
grid = {{ size = [1.0, 1.0], resolution = [12, 12] }}
density = 0.2
stretch = {{ stiffness = {:.6g} }}
pins = {{ edges = ["z-"] }}
)",
                                                     stiffness);
            c.criterion = {{Quantity::kStrain, 0.0, 0.05 + 4.0 / stiffness},
                           {Quantity::kLost, -kNone, 0.5, Verdict::kDissipated}};
            c.across = 1e3 * steps.length();
            c.up = stiffness;
            c.in_short = steps.substeps <= 16 && stiffness > 1.0 && stiffness < 1e11;
            cases.push_back(c);
        }
    }
}

/// The same in iterations, at 4.2 ms.
void add_iterations(std::vector<Case>& cases) {
    for (const double stiffness : {1e2, 1e4, 1e6, 1e8}) {
        for (const int iterations : {1, 2, 4, 16, 64}) {
            Case c;
            c.group = "iterations";
            c.name = fmt::format("k = {:.0e} N/m, {} iterations", stiffness, iterations);
            c.scene = head({1.0 / 60, 4}, 0.5) + fmt::format(R"([[cloth]]
grid = {{ size = [1.0, 1.0], resolution = [12, 12] }}
density = 0.2
stretch = {{ stiffness = {:.6g} }}
bend = {{ stiffness = 1.0e-3 }}
pins = {{ corners = ["x-z-", "x+z-"] }}
)",
                                                             stiffness);
            c.iterations = iterations;
            c.criterion = {{Quantity::kStrain, 0.0, 0.05 + 20.0 / stiffness},
                           {Quantity::kLost, -kNone, 0.5, Verdict::kDissipated}};
            c.across = iterations;
            c.up = stiffness;
            c.in_short = iterations <= 4 && stiffness >= 1e4;
            cases.push_back(c);
        }
    }
}

/// A light sheet that is held carries a heavy strip (ratio above 1), or a heavy one a light strip.
/// The springs are as stiff as the load asks for: 0.4 % at most.
void add_mass_ratios(std::vector<Case>& cases) {
    for (const double ratio : {1e-8, 1e-4, 1e0, 1e2, 1e4, 1e6, 1e8}) {
        for (const Steps& steps : {kSteps[1], kSteps[2], kSteps[3], kSteps[4]}) {
            Case c;
            c.group = "mass ratio";
            c.name = fmt::format("hanging : carrying = {:.0e}, {}", ratio, step_text(steps));
            const double heavier = std::sqrt(std::max(1.0, ratio));  // about 0.2 kg/m^2
            c.scene =
                head(steps, 0.5) + fmt::format(R"([[cloth]]
name = "carries"
grid = {{ size = [0.5, 0.5], resolution = [6, 6] }}
rotate = [1.0, 0.0, 0.0, 90.0]
density = {2:.6g}
stretch = {{ stiffness = {0:.6g} }}
pins = {{ edges = ["z-"] }}
[[cloth]]
name = "hangs"
grid = {{ size = [0.5, 0.5], resolution = [6, 6] }}
rotate = [1.0, 0.0, 0.0, 90.0]
translate = [0.0, -0.5, 0.0]
density = {1:.6g}
stretch = {{ stiffness = {0:.6g} }}
[[attachment]]
a = "hangs"
b = "carries"
edges = ["z-"]
stiffness = {0:.6g}
)",
                                               1e3 * heavier, 0.2 / heavier * ratio, 0.2 / heavier);
            c.criterion = {{Quantity::kStrain, 0.0, 0.05}};
            c.across = 1e3 * steps.length();
            c.up = ratio;
            c.in_short = steps.substeps <= 4 && ratio > 1e-5 && ratio < 1e7;
            cases.push_back(c);
        }
    }
}

/// A beam of 0.6 m that is held at one end bends under its weight.
void add_poisson(std::vector<Case>& cases) {
    for (const double poisson : {-0.5, 0.0, 0.4, 0.49, 0.495}) {
        for (const Steps& steps : {kSteps[0], kSteps[1], kSteps[2], kSteps[3], kSteps[4]}) {
            Case c;
            c.group = "Poisson's ratio";
            c.name = fmt::format("nu = {}, {}", poisson, step_text(steps));
            c.scene = head(steps, 0.5) + fmt::format(R"([[solid]]
grid = {{ size = [0.6, 0.2, 0.2], resolution = [7, 3, 3] }}
density = 1000.0
young = 1.0e6
poisson = {}
pins = {{ faces = ["x-"] }}
)",
                                                     poisson);
            c.criterion = {{Quantity::kStrain, 0.0, 0.05},
                           {Quantity::kSize, 0.7, 1.3},
                           {Quantity::kLost, -kNone, 0.5, Verdict::kDissipated}};
            c.across = 1e3 * steps.length();
            c.up = poisson;
            c.in_short = steps.substeps <= 4 && (poisson < 0.0 || poisson > 0.49);
            cases.push_back(c);
        }
    }
}

// ---- single cases ----

Case single(const std::string& name, const std::string& scene, std::vector<Bound> criterion) {
    Case c;
    c.group = "extreme";
    c.name = name;
    c.scene = scene;
    c.criterion = std::move(criterion);
    c.in_short = true;
    return c;
}

std::string sheet(double size, double stiffness, const std::string& more, int resolution = 12) {
    return fmt::format(R"([[cloth]]
grid = {{ size = [{0:.6g}, {0:.6g}], resolution = [{1}, {1}] }}
density = 0.2
stretch = {{ stiffness = {2:.6g} }}
{3}
)",
                       size, resolution, stiffness, more);
}

const char* const kHeld = "pins = { edges = [\"z-\"] }";
const char* const kAnyState = "[guard]\nmax_speed = 1.0e18\nmax_strain = 1.0e18\n";

/// From a millimetre to a kilometre, and far from the origin. Forces are as in a sheet of 1 m, with
/// times as long as falls take.
void add_sizes(std::vector<Case>& cases) {
    for (const double size : {1e-3, 1e3}) {
        const double time = std::sqrt(size);
        cases.push_back(single(fmt::format("a sheet of {:g} m", size),
                               head({time / 60, 16}, 0.5 * time) + sheet(size, 1e3 * size, kHeld),
                               {{Quantity::kStrain, 0.0, 0.05}}));
    }
    for (const double far : {100.0, 10000.0}) {
        cases.push_back(single(
            fmt::format("a sheet {:g} m from the origin", far),
            head(kUsual, 0.5) +
                sheet(1.0, 1e3, fmt::format("translate = [{0:g}, {0:g}, 0.0]\n{1}", far, kHeld)),
            {{Quantity::kStrain, 0.0, 0.05}}));
    }
}

/// Triangles and tetrahedra that are hardly there.
void add_slivers(std::vector<Case>& cases) {
    for (const double thin : {1e-2, 1e-4, 1e-6}) {
        for (const char* made :
             {"stretch = { stiffness = 1.0e3 }",
              "membrane = { young = 1.0e6, poisson = 0.3, thickness = 1.0e-3 }"}) {
            cases.push_back(
                single(fmt::format("triangles {:g} times as wide as long, {:.{}}", thin, made, 8),
                       head(kUsual, 0.5) + fmt::format(R"([[cloth]]
grid = {{ size = [1.0, {:g}], resolution = [7, 7] }}
density = 0.2
{}
pins = {{ edges = ["x-"] }}
)",
                                                       thin, made),
                       {{Quantity::kSize, 0.8, 1.2}}));
        }
        cases.push_back(single(fmt::format("tetrahedra {:g} times as thick as long", thin),
                               head(kUsual, 0.5) + fmt::format(R"([[solid]]
grid = {{ size = [1.0, 1.0, {:g}], resolution = [4, 4, 3] }}
density = 1000.0
young = 1.0e6
poisson = 0.3
pins = {{ faces = ["x-"] }}
)",
                                                               thin),
                               {{Quantity::kStrain, 0.0, 0.1}}));
    }
}

/// A block without gravity that starts in no shape at all goes back to its own. A point and a line
/// have no reason to leave their place.
void add_starts(std::vector<Case>& cases) {
    const std::string block = head({1.0 / 60, 4}, 5.0, "gravity = [0.0, 0.0, 0.0]") +
                              R"([[solid]]
grid = { size = [0.3, 0.3, 0.3], resolution = [4, 4, 4] }
density = 1000.0
young = 1.0e5
poisson = 0.4
damping = 2.0
)" + kAnyState;
    struct Named {
        const char* name;
        Start start;
        double strain;
    };
    for (const Named& n :
         {Named{"at random on a sphere", Start::kOnSphere, 0.01},
          Named{"at random in a plane", Start::kInPlane, 0.01},
          Named{"inverted", Start::kInverted, 0.01}, Named{"on a line", Start::kOnLine, kNone},
          Named{"in a point", Start::kInPoint, kNone}}) {
        Case c = single(fmt::format("a block that starts {}", n.name), block,
                        {{Quantity::kStrain, 0.0, n.strain}});
        c.start = n.start;
        cases.push_back(c);
    }
    Case stretched = single("a sheet that starts 100 times as long",
                            head({1.0 / 60, 4}, 5.0, "gravity = [0.0, 0.0, 0.0]") +
                                sheet(1.0, 1e3, "damping = 2.0", 8) + kAnyState,
                            {{Quantity::kStrain, 0.0, 0.1}});
    stretched.start = Start::kStretched;
    cases.push_back(stretched);
}

void add_impacts(std::vector<Case>& cases) {
    const std::string fast = "[guard]\nmax_speed = 1.0e5\n";
    cases.push_back(single("a ball of 0.3 m hits a sheet at 1000 m/s",
                           head({1.0 / 600, 4}, 0.02, "gravity = [0.0, 0.0, 0.0]") +
                               sheet(0.4, 1e4, "translate = [0.0, 2.0, 0.0]") +
                               R"([[obstacle]]
shape = "sphere"
center = [0.0, 0.0, 0.0]
radius = 0.3
motion = { velocity = [0.0, 1000.0, 0.0] }
)" + fast,
                           {{Quantity::kRise, 15.0, 30.0}}));
    Case thrown = single("a sheet is thrown at a box at 1000 m/s",
                         head({1.0 / 600, 4}, 0.02) +
                             sheet(0.4, 1e4, "translate = [0.0, 2.0, 0.0]") + R"([[obstacle]]
shape = "box"
center = [0.0, 0.0, 0.0]
size = [2.0, 0.2, 2.0]
)" + fast,
                         {{Quantity::kRise, -2.0, 30.0}});
    thrown.start = Start::kThrown;
    cases.push_back(thrown);
}

/// Nothing but gravity; nothing at all.
void add_falls(std::vector<Case>& cases) {
    cases.push_back(
        single("a stiff sheet falls freely for 4 s",
               head({1.0 / 12, 4}, 4.0) + sheet(1.0, 1e8, "bend = { stiffness = 1.0e2 }"),
               {{Quantity::kFall, 0.9999, 1.0001}, {Quantity::kStrain, 0.0, 1e-3}}));
    cases.push_back(single("a sheet lies on the ground for a minute",
                           head({1.0 / 60, 4}, 60.0) +
                               sheet(1.0, 1e4, "bend = { stiffness = 1.0e-3 }", 6) +
                               R"([[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.3
)",
                           {{Quantity::kDrift, 0.0, 1e-4}, {Quantity::kStrain, 0.0, 1e-3}}));
    Case hour = single("a sheet lies on the ground for an hour",
                       head({1.0 / 12, 1}, 3600.0) +
                           sheet(1.0, 1e4, "bend = { stiffness = 1.0e-3 }", 4) + R"([[obstacle]]
shape = "plane"
point = [0.0, 0.0, 0.0]
friction = 0.3
)",
                       {{Quantity::kDrift, 0.0, 1e-4}, {Quantity::kStrain, 0.0, 1e-3}});
    hour.in_short = false;
    cases.push_back(hour);
    Case twist =
        single("a strip is twisted 24 times in 24 s", head({1.0 / 60, 8}, 24.0) + R"([[cloth]]
grid = { size = [0.2, 1.0], resolution = [5, 21] }
density = 0.2
stretch = { stiffness = 1.0e3 }
bend = { stiffness = 1.0e-3 }
damping = 1.0
[[cloth.pins]]
edges = ["z-"]
[[cloth.pins]]
edges = ["z+"]
motion = { angular_velocity = 360.0, axis = [0.0, 0.0, 1.0] }
)",
               {{Quantity::kStrain, 0.0, 4.0}});
    twist.in_short = false;
    cases.push_back(twist);
}

const char* name_of(Quantity quantity) {
    switch (quantity) {
        case Quantity::kStrain:
            return "strain of edges";
        case Quantity::kWorst:
            return "strain of the worst edge";
        case Quantity::kFall:
            return "fall / free fall";
        case Quantity::kRise:
            return "rise [m]";
        case Quantity::kDrift:
            return "drift / size";
        case Quantity::kSize:
            return "size / size at rest";
        case Quantity::kLost:
            return "energy lost / had";
        case Quantity::kCrossings:
            return "crossing triangles";
    }
    return "";
}

std::string text_of(const Bound& bound) {
    const char* name = name_of(bound.quantity);
    if (std::isinf(bound.low) || bound.low == 0.0)
        return fmt::format("{} <= {:g}", name, bound.high);
    return fmt::format("{:g} <= {} <= {:g}", bound.low, name, bound.high);
}

}  // namespace

const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::kStable:
            return "stable";
        case Verdict::kDissipated:
            return "dissipated";
        case Verdict::kUnconverged:
            return "unconverged";
        case Verdict::kExploded:
            return "exploded";
        case Verdict::kStopped:
            return "stopped";
    }
    return "";
}

std::string text_of(const std::vector<Bound>& criterion) {
    std::vector<std::string> parts;
    for (const Bound& bound : criterion) parts.push_back(text_of(bound));
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::vector<Map> all_maps() {
    return {{"stiffness", "springs of a sheet that is held", "step [ms]", "stiffness [N/m]"},
            {"iterations", "the same, 4.2 ms", "iterations", "stiffness [N/m]"},
            {"mass ratio", "one sheet hangs on another", "step [ms]", "hanging : carrying"},
            {"Poisson's ratio", "a beam that is held", "step [ms]", "Poisson's ratio"},
            {"contact", "one block lies on another", "step [ms]", "upper : lower"}};
}

std::vector<Case> all_cases() {
    std::vector<Case> cases;
    add_stiffness(cases);
    add_iterations(cases);
    add_mass_ratios(cases);
    add_poisson(cases);
    add_sizes(cases);
    add_slivers(cases);
    add_starts(cases);
    add_impacts(cases);
    add_falls(cases);
    add_contacts(cases);
    return cases;
}

}  // namespace weft::stability
