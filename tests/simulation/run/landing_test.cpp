// What lands on obstacles has no more energy than it had: sheets that fall on each other there, and
// a block that comes by more than its edges' length within a frame.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "simulation/simulation.h"
#include "simulation/state/diagnostics.h"
#include "tests/simulation/run/physics.h"

namespace weft::test {
namespace {

/// [J] what a run has at most, above what it began with, and what it began with above its end.
struct Account {
    double gained, fallen;
};

class Landing : public EverySolver {
protected:
    static Account run_of(const std::string& text, int frames) {
        Run run(scene_of(text));
        const double start = run.energy();
        double most = start;
        for (int frame = 0; frame < frames; ++frame) most = std::max(most, run.advance());
        return {most - start, start - run.energy()};
    }

    /// What a run has at most, above what it has behind that many frames [J].
    static double gained_behind(const std::string& text, int landed, int frames) {
        Run run(scene_of(text));
        for (int frame = 0; frame < landed; ++frame) run.advance();
        const double start = run.energy();
        double most = start;
        for (int frame = landed; frame < frames; ++frame) most = std::max(most, run.advance());
        return most - start;
    }

    class Run {
    public:
        explicit Run(const Scene& scene) : run_(scene, options(), warnings_) {}
        Energies energies() { return run_.energies(); }
        double energy() { return energies().total(); }
        /// Its energy behind the next frame [J].
        double advance() {
            run_.advance();
            return energy();
        }

    private:
        static SimulationOptions options() {
            SimulationOptions options;
            options.devices = "cpu/1";
            options.calibrate = false;
            return options;
        }

        Warnings warnings_;
        Simulation run_;
    };
};

/// Sheets above a plane and each other, to be followed by what [contact] has.
/// size  of a side [m]; resolution: vertices on it
std::string pile_of(int sheets, double size, int resolution) {
    std::string text = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 10
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
)";
    for (int sheet = 0; sheet < sheets; ++sheet) {
        text += fmt::format(R"(
[[cloth]]
grid = {{ size = [{0}, {0}], resolution = [{1}, {1}] }}
translate = [0, {2}, 0]
density = 0.2
stretch = {{ stiffness = 2000 }}
)",
                            size, resolution, 0.005 + 0.0045 * sheet);
    }
    return text + "[contact]\n";
}

class LandingSheets : public Landing {};
class LandingPile : public Landing {};
class LyingPile : public Landing {};
class LoadedPile : public Landing {};
class LandingTogether : public Landing {};
class LandingOnMesh : public Landing {};
class LandingTower : public Landing {};

/// Rounds that knew of the sheets' contacts alone led the lowest one into what bears it. On a plane
/// five such sheets stored twelve times what they had, and on a box they exploded.
TEST_P(LandingSheets, GainNothing) {
    const std::string plane = "shape = \"plane\"\npoint = [0, 0.15, 0]\n";
    const std::string capsule =
        "shape = \"capsule\"\nstart = [-0.3, 0.05, 0]\nend = [0.3, 0.02, 0]\nradius = 0.1\n";
    for (const std::string& shape : {plane, capsule}) {
        std::string text = R"(
[scene]
frames = 1
dt = 0.016666667
[contact]
thickness = 0.004
friction = 0.2
)";
        for (int sheet = 0; sheet < 4; ++sheet) {
            text += fmt::format(R"(
[[cloth]]
grid = {{ size = [0.5, 0.5], resolution = [13, 13] }}
rotate = [0, 1, 0, {}]
translate = [0.01, {}, 0.02]
density = 0.1
stretch = {{ stiffness = 5000 }}
)",
                                7 * sheet, 0.26 + 0.02 * sheet);
        }
        text += "[[obstacle]]\n" + shape + "friction = 0.2\n";
        const Account account = run_of(text, 24);
        EXPECT_LT(account.gained, 0.02 * account.fallen) << shape;
        EXPECT_GT(account.fallen, 0.05) << shape;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingSheets, kMethods, name_of_method);

/// Rounds that lead single bodies, whole piles and their halves alone stop no pile of so many: what
/// came on from above pressed the lower sheets into each other, and they stored twenty times what
/// they had fallen.
TEST_P(LandingPile, GainsNothing) {
    const Account account = run_of(pile_of(32, 0.1, 5) + "thickness = 0.004\n", 8);
    EXPECT_LT(account.gained, 0.01 * account.fallen);
    EXPECT_GT(account.fallen, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingPile, kMethods, name_of_method);

/// Three thicknesses to an edge. What held a sheet up in the substep before held it up while it
/// rose, too, and edges began and ceased to press at once: such piles swelled, by 6 mJ of 25.
TEST_P(LyingPile, StaysCalm) {
    const std::string contact = "thickness = 0.004\nfriction = 0.3\n";
    const std::string solver = "[solver]\niterations = 10\n";
    EXPECT_LT(gained_behind(pile_of(8, 0.2, 16) + contact + solver, 7, 30), 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Methods, LyingPile,
                         testing::Values(Method::kXpbd, Method::kVbd, Method::kSosd),
                         name_of_method);

/// Where there was a solid in the scene, sheets were led before the first iteration, too. They
/// start from what held them up already, and had that twice: they gained as much as the block falls
/// by.
TEST_P(LoadedPile, GainsNothing) {
    const std::string block = R"(
[[solid]]
grid = { size = [0.06, 0.06, 0.06], resolution = [3, 3, 3] }
translate = [0, 0.072, 0]
density = 300
young = 1e5
poisson = 0.3
)";
    const Account account = run_of(pile_of(6, 0.12, 6) + "thickness = 0.004\n" + block, 12);
    EXPECT_LT(account.gained, 0.01 * account.fallen);
    EXPECT_GT(account.fallen, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Methods, LoadedPile, kMethods, name_of_method);

/// A block above a sheet, which come to what they land on by 8 mm per substep, if there are four in
/// a frame; an obstacle is to follow.
std::string block_above_sheet(int substeps) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = {}
[contact]
thickness = 0.004
friction = 0.3
[[cloth]]
grid = {{ size = [0.25, 0.25], resolution = [8, 8] }}
translate = [0, 0.205, 0]
density = 0.5
stretch = {{ stiffness = 1200 }}
[[solid]]
grid = {{ size = [0.15, 0.045, 0.12], resolution = [3, 3, 3] }}
translate = [0, 0.2325, 0]
density = 120
young = 5e6
poisson = 0.4
[[obstacle]]
)",
                       substeps);
}

/// In the substep in which the sheet came to an obstacle, planes between the two stayed where the
/// sheet had been: the block's lower vertices were held back there, and its strain had a hundred
/// times the energy of the fall.
TEST_P(LandingTogether, GainsNothing) {
    for (const char* shape : {"shape = \"plane\"\npoint = [0, 0, 0]\n",
                              "shape = \"sphere\"\ncenter = [0, -0.3, 0]\nradius = 0.3\n"}) {
        const Account account = run_of(block_above_sheet(4) + "friction = 0.3\n" + shape, 18);
        EXPECT_LT(account.gained, 1e-3 * account.fallen) << shape;
        EXPECT_GT(account.fallen, 0.2) << shape;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingTogether, kMethods, name_of_method);

class LandingOnMeshTogether : public Landing {};

/// Before a mesh, planes do not move with what falls. They held the block back at its lower
/// vertices alone, with fifteen times the energy of the fall.
TEST_P(LandingOnMeshTogether, GainsNothing) {
    const std::string floor = "shape = \"mesh\"\ngrid = { size = [1, 1], resolution = [9, 9] }\n";
    const Account account = run_of(block_above_sheet(6) + floor, 18);
    EXPECT_LT(account.gained, 1e-3 * account.fallen);
    EXPECT_GT(account.fallen, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingOnMeshTogether, kMethods, name_of_method);

/// Of blocks of 0.1 m, each a little beside the one below, above what is to follow.
/// height  of the lowest one's middle [m]
std::string tower_of(int blocks, double height) {
    std::string text = R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
[contact]
)";
    for (int block = 0; block < blocks; ++block) {
        text += fmt::format(R"(
[[solid]]
grid = {{ size = [0.1, 0.1, 0.1], resolution = [4, 4, 4] }}
translate = [{}, {}, 0]
density = 300
young = 1e7
poisson = 0.4
)",
                            block % 2 == 0 ? 0.003 : -0.003, height + 0.12 * block);
    }
    return text;
}

/// A lone block was not led out of a mesh before the first iteration, as it was out of convex
/// obstacles: it stored two to seventeen times the energy of its fall. Two gave way to each other
/// in the first round, when they were still in each other, and kept that strain.
TEST_P(LandingOnMesh, GainsLittle) {
    const std::string floor = R"(
[[obstacle]]
shape = "mesh"
grid = { size = [2, 2], resolution = [12, 12] }
)";
    for (const std::string& tower : {tower_of(1, 0.5), tower_of(2, 0.15)}) {
        const Account account = run_of(tower + floor, 24);
        EXPECT_LT(account.gained, 0.1 * account.fallen) << tower;
        EXPECT_GT(account.fallen, 0.1) << tower;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingOnMesh, kMethods, name_of_method);

/// The step that bodies take in common took what they do to each other, far more than they lack,
/// at levers of another moment, and turned them by that: up to 4e4 J.
TEST_P(LandingTower, DoesNotExplode) {
    const std::string floor = R"(
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
)";
    const Account account = run_of(tower_of(4, 0.15) + floor, 24);
    EXPECT_LT(account.gained, 0.1 * account.fallen);
    EXPECT_GT(account.fallen, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingTower, kMethods, name_of_method);

/// At 5 m/s, by 2 cm per substep.
std::string falling_block(int iterations, const std::string& contact) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 4
[solver]
iterations = {}
[[solid]]
grid = {{ size = [0.15, 0.12, 0.15], resolution = [4, 4, 4] }}
rotate = [-0.6, 0.73, 0.13, 71.7]
translate = [0.03, 1.4, 0.086]
density = 84.8
young = 4.3e6
poisson = 0.18
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
friction = 0.5
{})",
                       iterations, contact);
}

class LandingBlock : public Landing {
protected:
    /// What it gains at most; it falls by 3 J [J].
    static double most_gained() {
        double most = 0.0;
        for (const char* contact : {"", "[contact]\nthickness = 0.005\n"}) {
            for (const int iterations : {2, 8}) {
                const Account account = run_of(falling_block(iterations, contact), 45);
                EXPECT_GT(account.fallen, 1.0);
                most = std::max(most, account.gained);
            }
        }
        return most;
    }
};

/// Newton's system led all of it into the plane, and its lowest vertices were pushed out behind
/// that, with up to seven times the energy of the fall.
TEST_P(LandingBlock, GainsNothing) { EXPECT_LT(most_gained(), 3e-3); }

INSTANTIATE_TEST_SUITE_P(Methods, LandingBlock,
                         testing::Values(Method::kVbd, Method::kSosd, Method::kNewton),
                         name_of_method);

class LandingBlockOf : public LandingBlock {};

/// Two hundred times the fall before blocks that land were led out as wholes, and up to four times
/// by jpgd before what their corners bear was seen by that.
TEST_P(LandingBlockOf, GainsLittle) { EXPECT_LT(most_gained(), 0.3); }

INSTANTIATE_TEST_SUITE_P(Methods, LandingBlockOf, testing::Values(Method::kXpbd, Method::kJpgd),
                         name_of_method);

/// On a corner, from 10 cm, by default.
std::string block_on_its_corner(double young, const std::string& contact) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
[[solid]]
grid = {{ size = [0.1, 0.1, 0.2], resolution = [4, 4, 6] }}
rotate = [0.705, 0.0825, 0.361, 60]
translate = [0, 0.2, 0]
density = 300
young = {}
poisson = 0.45
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
{})",
                       young, contact);
}

class LandingCorner : public Landing {};

/// The corner stopped, and few iterations let the rest go on and crush it: xpbd stored 20 times
/// what there was.
TEST_P(LandingCorner, StoresNoMoreThanItFell) {
    for (const double young : {1e5, 1e6, 1e7}) {
        for (const char* contact : {"", "[contact]\n"}) {
            Run run(scene_of(block_on_its_corner(young, contact)));
            const double start = run.energies().gravity;
            double most = 0.0;
            for (int frame = 0; frame < 18; ++frame) {
                run.advance();
                const Energies now = run.energies();
                most = std::max(most, now.strain() / (start - now.gravity));
            }
            EXPECT_LT(most, 1.0) << young << contact;
            EXPECT_GT(start - run.energies().gravity, 0.4);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingCorner, kMethods, name_of_method);

/// Across a rod that is far narrower than its triangles.
std::string block_across_a_rod(const char* resolution, double young, double radius) {
    return fmt::format(R"(
[scene]
frames = 1
dt = 0.016666667
substeps = 10
[[solid]]
grid = {{ size = [0.05, 0.1, 0.4], resolution = {} }}
translate = [0.07, 0.3, 0.09]
density = 300
young = {}
poisson = 0.45
[[obstacle]]
shape = "capsule"
start = [-0.3, 0, 0]
end = [0.3, 0, 0]
radius = {}
)",
                       resolution, young, radius);
}

class LandingOnRod : public Landing {};

/// Its corners took what the rod pushes between them for what each of them bears, and it was thrown
/// by all solvers but xpbd, with up to 4e4 J.
TEST_P(LandingOnRod, TipsOver) {
    for (const auto& [resolution, young, radius] :
         {std::tuple{"[2, 2, 2]", 1e9, 0.1}, std::tuple{"[4, 6, 12]", 1e8, 0.01}}) {
        Run run(scene_of(block_across_a_rod(resolution, young, radius)));
        const Energies start = run.energies();
        for (int frame = 0; frame < 16; ++frame) {
            const double energy = run.advance();
            EXPECT_LT(energy, start.total() + 1e-3) << young << ", frame " << frame;
        }
        const Energies end = run.energies();
        EXPECT_GT(end.kinetic, 0.1) << "it turns";
        EXPECT_LT(end.kinetic, 1.0);
        EXPECT_GT(start.gravity - end.gravity, 0.8) << "of 2.1 J in free fall";
        EXPECT_LT(start.gravity - end.gravity, 1.8);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingOnRod, kMethods, name_of_method);

class LandingStep : public Landing {};

/// On a box that stands out of a plane by less than the thickness. What bore it was put down to
/// the plane, which comes first, and it never lay still.
TEST_P(LandingStep, LiesOnWhatIsNearer) {
    const std::string text = R"(
[scene]
frames = 1
dt = 0.016666667
[[solid]]
grid = { size = [0.2, 0.1, 0.2], resolution = [5, 4, 5] }
translate = [0, 0.0545, 0]
density = 500
young = 1e6
poisson = 0.3
[[obstacle]]
shape = "plane"
point = [0, 0, 0]
friction = 0.4
[[obstacle]]
shape = "box"
center = [0, -0.046, 0]
size = [1, 0.1, 1]
friction = 0.4
[contact]
thickness = 0.01
)";
    Run run(scene_of(text));
    for (int frame = 0; frame < 60; ++frame) run.advance();
    EXPECT_LT(run.energies().kinetic, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Methods, LandingStep, kMethods, name_of_method);

}  // namespace
}  // namespace weft::test
