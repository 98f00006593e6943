// Every mistake a scene can contain: the message names the place, the key, the value, the remedy.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "scene_text.h"
#include "simulation/scene/read_scene.h"

namespace weft {
namespace {

std::string message_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    try {
        parse_scene(text, "s.toml", overrides);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

struct Mistake {
    const char* name;
    const char* from;
    const char* to;
    const char* message;  ///< part of it
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class SceneMistake : public testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, IsExplained) {
    const Mistake& mistake = GetParam();
    const std::string message =
        message_of(test::replaced(test::kFullScene, mistake.from, mistake.to));
    EXPECT_NE(message.find(mistake.message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.rfind("s.toml:", 0), 0U) << message;
}

const Mistake kMistakes[] = {
    {"BrokenToml", "frames = 3", "frames = = 3", "s.toml:3:10: not valid TOML"},
    {"PartsOfGrid", "corners = [\"x-z-\", \"x+z-\"]", "parts = [\"hem\"]",
     "parts = [\"hem\"]: only a cloth's mesh file has parts; use vertices or box"},
    {"DuplicateKey", "dt = 0.02", "dt = 0.02\ndt = 0.03", "not valid TOML"},
    {"UnknownKey", "frames = 3", "framez = 3",
     "s.toml:3:1: unknown key 'framez' in scene; did you mean 'frames'?"},
    {"UnknownKeyInCloth", "density = 0.2", "densty = 0.2",
     "unknown key 'densty' in cloth[0]; did you mean 'density'?"},
    {"UnknownTable", "[solver]", "[sovler]", "unknown key 'sovler'; did you mean 'solver'?"},
    {"NothingNear", "frames = 3", "quux = 3", "unknown key 'quux' in scene; known: name, frames"},
    {"KeyOfAnotherShape", "point = [0.0, -1.0, 0.0]", "radius = 1.0",
     "unknown key 'radius' in obstacle[1]"},
    {"MissingKey", "frames = 3\n", "", "scene.frames is missing: expected an integer"},
    {"MissingStretch", "stretch = { stiffness = 1.0e4 }\n", "",
     "stretch: is missing: a cloth needs one or more of stretch, membrane, woven"},
    {"WrongType", "frames = 3", "frames = \"three\"",
     "s.toml:3:10: scene.frames = \"three\": expected an integer"},
    {"FractionForInteger", "frames = 3", "frames = 2.5", "scene.frames = 2.5: expected an integer"},
    {"DateForNumber", "dt = 0.02", "dt = 1979-05-27", "scene.dt = a date or time: expected a num"},
    {"TableForList", "gravity = [0.0, -9.81, 0.0]", "gravity = { y = 1 }",
     "scene.gravity = a table: expected a list of 3 numbers [m/s^2]"},
    {"ListTooShort", "gravity = [0.0, -9.81, 0.0]", "gravity = [0.0, -9.81]",
     "expected a list of 3 numbers [m/s^2], got 2"},
    {"TextInList", "gravity = [0.0, -9.81, 0.0]", "gravity = [0.0, \"down\", 0.0]",
     "scene.gravity[1] = \"down\": expected a list of 3 numbers"},
    {"TableForTables", "[[obstacle]]\nname", "[obstacle]\nname", "not valid TOML"},
    {"NegativeDensity", "density = 0.2", "density = -0.2",
     "cloth[0].density = -0.2: must be greater than 0 [kg/m^2]"},
    {"ZeroDensity", "density = 0.2", "density = 0", "cloth[0].density = 0: must be greater than 0"},
    {"NegativeDt", "dt = 0.02", "dt = -0.02", "scene.dt = -0.02: must be greater than 0 [s]"},
    {"ZeroDt", "dt = 0.02", "dt = 0.0", "scene.dt = 0: must be greater than 0 [s]"},
    {"NegativeStiffness", "stiffness = 1.0e4", "stiffness = -1.0e4",
     "cloth[0].stretch.stiffness = -10000: must be greater than 0 [N/m]"},
    {"NegativeBend", "stiffness = 1.0e-4", "stiffness = -1.0",
     "cloth[0].bend.stiffness = -1: must be at least 0 [J]"},
    {"NegativeDamping", "damping = 0.5", "damping = -0.5", "cloth[0].damping = -0.5: must be at l"},
    {"ZeroSubsteps", "substeps = 2", "substeps = 0", "scene.substeps = 0: must be at least 1"},
    {"ZeroIterations", "iterations = 4", "iterations = 0", "solver.iterations = 0: must be at le"},
    {"NegativeFrames", "frames = 3", "frames = -3", "scene.frames = -3: must be at least 1"},
    {"HugeFrames", "frames = 3", "frames = 9223372036854775807", "must be at most 10000000"},
    {"Infinite", "dt = 0.02", "dt = inf", "scene.dt = inf: must be a finite number [s]"},
    {"NotANumber", "density = 0.2", "density = nan", "cloth[0].density = nan: must be a finite"},
    {"Overflow", "density = 0.2", "density = 1e300", "must be at most 1000000 [kg/m^2]"},
    {"Underflow", "density = 0.2", "density = 1e-300", "too small for single precision"},
    {"HugeGrid", "resolution = [5, 9]", "resolution = [100000, 100000]",
     "vertices, more than the 20000000 that indices can count"},
    {"HugeResolution", "resolution = [5, 9]", "resolution = [4294967296, 9]",
     "cloth[0].grid.resolution[0] = 4294967296: must be at most 1000000"},
    {"TinyGrid", "resolution = [5, 9]", "resolution = [1, 9]", "must be at least 2"},
    {"ThinCylinder", "resolution = [8, 4]", "resolution = [2, 4]",
     "a cylinder needs at least 3 vertices around"},
    {"TwoShapes", "scale = 0.5", "mesh = \"a.obj\"",
     "cloth[0]: needs exactly one of grid, cylinder, mesh, has 2"},
    {"NoShape", "cylinder = { radius = [0.2, 0.4], height = 0.5, resolution = [8, 4] }\n", "",
     "cloth[1]: needs exactly one of grid, cylinder, mesh, has 0"},
    {"ZeroScale", "scale = 0.5", "scale = 0.0", "cloth[0].scale = 0: must be at least"},
    {"ZeroAxis", "rotate = [0.0, 0.0, 1.0, 90.0]", "rotate = [0, 0, 0, 90]",
     "rotate = [[0, 0, 0, 90]]: the axis"},
    {"UnknownSolver", "\"xpbd\"", "\"xpdb\"",
     "solver.method = \"xpdb\": unknown; did you mean 'xpbd'?"},
    {"UnknownShape", "\"sphere\"", "\"spere\"", "did you mean 'sphere'?"},
    {"MeshObstacle", "shape = \"sphere\"", "shape = \"mesh\"",
     "unknown key 'center' in obstacle[0]"},
    {"ParentUnknown", "[[obstacle]]\nshape = \"plane\"",
     "[[obstacle]]\nparent = \"bal\"\nshape = \"plane\"", "parent = \"bal\": no obstacle"},
    {"ContactSelf", "[solver]", "[contact]\nself = 1\n[solver]",
     "contact.self = 1: expected true or false"},
    {"ContactThickness", "[solver]", "[contact]\nthickness = 0\n[solver]",
     "contact.thickness = 0: must be greater than 0 [m]"},
    {"ContactStiffness", "[solver]", "[contact]\nstiffness = 1e4\n[solver]",
     "contact.stiffness = 10000: must be at most 1000"},
    {"ContactKey", "[solver]", "[contact]\nthicknes = 0.01\n[solver]", "did you mean 'thickness'?"},
    {"ZeroYoung", "young = 1.0e5", "young = 0", "solid[0].young = 0: must be greater than 0 [Pa]"},
    {"Incompressible", "poisson = 0.45", "poisson = 0.5",
     "solid[0].poisson = 0.5: must be at most 0.495"},
    {"PoissonTooLow", "poisson = 0.45", "poisson = -1",
     "solid[0].poisson = -1: must be at least -0.5"},
    {"MembranePoisson", "poisson = 0.3", "poisson = 0.7", "cloth[2].membrane.poisson = 0.7: must"},
    {"SolidWithoutShape", "grid = { size = [0.3, 0.2, 0.1], resolution = [4, 3, 2] }\n", "",
     "solid[0]: needs exactly one of grid, mesh, has 0"},
    {"FlatBlock", "resolution = [4, 3, 2]", "resolution = [4, 3, 1]", "must be at least 2"},
    {"HugeBlock", "resolution = [4, 3, 2]", "resolution = [9000, 9000, 9000]",
     "vertices, more than the 20000000 that indices can count"},
    {"OutlineOfOtherSigns", "resolution = [4, 3, 2]", "resolution = [4, 3, 2], outline = [\"#x\"]",
     "expected rows of '#' and '.'"},
    {"RaggedOutline", "resolution = [4, 3, 2]", "resolution = [4, 3, 2], outline = [\"##\", \"#\"]",
     "all as long"},
    {"EmptyOutline", "resolution = [4, 3, 2]", "resolution = [4, 3, 2], outline = [\"...\"]",
     "has no '#'"},
    {"OutlineTooFine", "resolution = [4, 3, 2]",
     "resolution = [4, 3, 2], outline = [\"#..#\", \"####\"]",
     "the outline's 4 x 2 places need at least 5 x 3 vertices"},
    {"FaceOfOutline", "resolution = [4, 3, 2]", "resolution = [4, 3, 2], outline = [\"##.\"]",
     "none with an outline"},
    {"NoCopies", "name = \"brick\"", "name = \"brick\"\ncopies = { count = 0 }",
     "copies.count = 0: must be at least 1"},
    {"CopiesTurnTwice", "name = \"brick\"",
     "name = \"brick\"\ncopies = { count = 2, rotate = [[1, 0, 0, 5], [0, 1, 0, 5]] }",
     "expected one turn for all copies"},
    {"NameOfACopy", "name = \"tube\"", "name = \"sheet\"\ncopies = { count = 2 }",
     "another cloth or solid has the name 'sheet'"},
    {"SolidHasClothName", "name = \"brick\"", "name = \"sheet\"",
     "another cloth or solid has the name 'sheet'"},
    {"CornerOfGridOnBlock", "\"x+y+z+\"", "\"x+z+\"",
     "solid[0].pins.corners[0] = \"x+z+\": unknown; known: x-y-z-"},
    {"PinsOfNothing", "pins = { faces = [\"x-\"], corners = [\"x+y+z+\"] }", "pins = {}",
     "pins: say which vertices: corners, edges"},
    {"UnknownFace", "faces = [\"x-\"]", "faces = [\"w-\"]", "unknown"},
    {"AttachmentToNothing", "b = \"brick\"", "b = \"bricks\"",
     "b = \"bricks\": no cloth or solid has this name; did you mean 'brick'?"},
    {"AttachmentToItself", "b = \"brick\"", "b = \"film\"", "another cloth or solid than a"},
    {"AttachmentOfNothing", "b = \"brick\"\ncorners = [\"x-z-\"]", "b = \"brick\"",
     "say which of its vertices"},
    {"AttachmentCorner", "b = \"brick\"\ncorners = [\"x-z-\"]",
     "b = \"brick\"\ncorners = [\"x-y-z-\"]", "only a solid's grid has such corners"},
    {"AttachmentFaces", "b = \"brick\"\ncorners = [\"x-z-\"]", "b = \"brick\"\nfaces = [\"x-\"]",
     "only a solid's grid has faces"},
    {"NegativeReach", "reach = 3.0", "reach = -1", "attachment[0].reach = -1: must be at least 0"},
    {"UnknownCorner", "\"x-z-\", ", "\"left\", ", "cloth[0].pins.corners"},
    {"CornerOfCylinder", "rims = [\"top\"]", "corners = [\"x-z-\"]", "only a grid has corners"},
    {"RimOfGrid", "corners = [\"x-z-\", \"x+z-\"]", "rims = [\"top\"]", "only a cylinder has rims"},
    {"NegativePin", "vertices = [30]", "vertices = [-1]", "vertices[0] = -1: must be at least 0"},
    {"InvertedBox", "vertices = [30]", "box = [[0, 0, 0], [1, -1, 1]]", "must be the lower one"},
    {"SameName", "name = \"tube\"", "name = \"sheet\"",
     "another cloth or solid has the name 'sheet'"},
    {"NameIsPath", "name = \"full\"", "name = \"../full\"", "expected a name that can be a file's"},
    {"KeysNotRising", "{ time = 1.0, ", "{ time = 0.0, ", "times must rise"},
    {"VelocityAndKeys", "motion = { velocity = [1.0, 0.0, 0.0] }",
     "motion = { velocity = [1, 0, 0], keyframes = [] }", "cannot stand beside velocity"},
    {"PointCapsule", "end = [2.0, 0.0, 0.0]", "end = [0.0, 0.0, 0.0]", "must not be the same poin"},
    {"ZeroNormal", "point = [0.0, -1.0, 0.0]", "point = [0, 0, 0]\nnormal = [0, 0, 0]",
     "must not be the zero vector"},
    {"NegativeFriction", "friction = 0.4", "friction = -0.4", "obstacle[0].friction = -0.4: must"},
    {"NegativeRadius", "radius = 0.3", "radius = -0.3", "obstacle[0].radius = -0.3: must be great"},
};

INSTANTIATE_TEST_SUITE_P(All, SceneMistake, testing::ValuesIn(kMistakes),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(SceneErrors, NoSceneFile) {
    EXPECT_THROW(
        {
            try {
                read_scene("no/such.toml");
            } catch (const UserError& error) {
                EXPECT_STREQ(error.what(), "no/such.toml: no such scene file");
                throw;
            }
        },
        UserError);
    EXPECT_THROW(read_scene("."), UserError);
}

TEST(SceneErrors, EmptyAndBinaryFiles) {
    EXPECT_NE(message_of("").find("scene is missing"), std::string::npos);
    EXPECT_NE(message_of(std::string("\x00\x01\xff\xfe", 4)).find("not valid TOML"),
              std::string::npos);
}

TEST(SceneErrors, DeepNestingIsRefused) {
    EXPECT_NE(message_of("a = " + std::string(100000, '[')).find("not valid TOML"),
              std::string::npos);
}

TEST(SceneErrors, NoCloth) {
    EXPECT_NE(
        message_of("cloth = []\n[scene]\nframes = 1\ndt = 0.1\n").find("at least one [[cloth]]"),
        std::string::npos);
}

}  // namespace
}  // namespace weft
