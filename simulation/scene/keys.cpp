#include "simulation/scene/keys.h"

#include "simulation/scene/limits.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/scene/scene.h"

namespace weft {
namespace {

const Range kLength = between(1e-6, 1e6);
const Range kPlace = between(-1e6, 1e6);
const Range kTime = between(0.0, 1e9);
const Range kVertices = between(2, 1e6);

const TableKeys& scene_table() {
    static const TableKeys table{{
        {.name = "name",
         .type = Type::kText,
         .help = "names the output folder; default: the file's own name"},
        {.name = "frames",
         .type = Type::kInteger,
         .help = "frames to simulate",
         .required = true,
         .range = between(1, 1e7)},
        {.name = "dt",
         .help = "duration of one frame",
         .unit = "s",
         .required = true,
         .range = positive_up_to(10.0)},
        {.name = "substeps",
         .type = Type::kInteger,
         .help = "steps per frame",
         .fallback = std::int64_t{1},
         .range = between(1, 1e5)},
        {.name = "gravity",
         .forms = {{3}},
         .help = "constant gravity; y is up",
         .unit = "m/s^2",
         .fallback = std::vector<double>{0.0, -9.81, 0.0},
         .range = between(-1e6, 1e6)},
        {.name = "gravity_keyframes",
         .forms = {{kAny, 4}},
         .help = "[time, x, y, z] by rising time, linear between; takes the place of gravity",
         .unit = "s, m/s^2",
         .range = between(-1e6, 1e6)},
        {.name = "size",
         .type = Type::kInteger,
         .help = "scales the resolutions of all grids and cylinders so that together they have "
                 "about this many vertices",
         .unit = "vertices",
         .range = between(16, static_cast<double>(kMaxVertices))},
    }};
    return table;
}

const TableKeys& solver_table() {
    static const TableKeys table{{
        {.name = "method",
         .type = Type::kText,
         .help = "solver",
         .fallback = std::string("xpbd"),
         .choices = method_names(),
         .later_choices = {"sosd"}},
        {.name = "iterations",
         .type = Type::kInteger,
         .help = "iterations per substep",
         .fallback = std::int64_t{SolverSettings{}.iterations},
         .range = between(1, 1e5)},
    }};
    return table;
}

const TableKeys& guard_table() {
    static const TableKeys table{{
        {.name = "max_speed",
         .help = "a vertex faster than this counts as exploded",
         .unit = "m/s",
         .fallback = Guard{}.max_speed,
         .range = positive()},
        {.name = "max_strain",
         .help = "an edge with |length / rest length - 1| beyond this counts as exploded",
         .fallback = Guard{}.max_strain,
         .range = positive()},
    }};
    return table;
}

const TableKeys& keyframe_table() {
    static const TableKeys table{{
        {.name = "time",
         .help = "time since the start",
         .unit = "s",
         .required = true,
         .range = kTime},
        {.name = "translate",
         .forms = {{3}},
         .help = "displacement from the place at the start",
         .unit = "m",
         .fallback = std::vector<double>{0, 0, 0},
         .range = kPlace},
        {.name = "rotate",
         .help = "angle about the motion's axis",
         .unit = "degrees",
         .fallback = 0.0,
         .range = between(-1e9, 1e9)},
    }};
    return table;
}

const TableKeys& motion_table() {
    static const TableKeys table{{
        {.name = "velocity",
         .forms = {{3}},
         .help = "constant velocity; or use keyframes",
         .unit = "m/s",
         .range = between(-1e4, 1e4)},
        {.name = "angular_velocity",
         .help = "constant rate of turn; or use keyframes",
         .unit = "degrees/s",
         .range = between(-1e6, 1e6)},
        {.name = "axis",
         .forms = {{3}},
         .help = "axis of the turn; any length",
         .fallback = std::vector<double>{0, 1, 0}},
        {.name = "center",
         .forms = {{3}},
         .help = "point that the axis goes through, at the start; default: the obstacle's own "
                 "centre, for pins the origin",
         .unit = "m",
         .range = kPlace},
        {.name = "keyframes",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "by rising time; linear between, held before the first and after the last",
         .table = &keyframe_table()},
    }};
    return table;
}

Key motion_key(std::string help) {
    return {
        .name = "motion", .type = Type::kTable, .help = std::move(help), .table = &motion_table()};
}

const TableKeys& grid_table() {
    static const TableKeys table{{
        {.name = "size",
         .forms = {{2}},
         .help = "width along x and depth along z",
         .unit = "m",
         .required = true,
         .range = kLength},
        {.name = "resolution",
         .type = Type::kInteger,
         .forms = {{2}},
         .help = "vertices along x and along z",
         .required = true,
         .range = kVertices},
    }};
    return table;
}

const TableKeys& cylinder_table() {
    static const TableKeys table{{
        {.name = "radius",
         .forms = {{2}},
         .help = "at the top and at the bottom",
         .unit = "m",
         .required = true,
         .range = kLength},
        {.name = "height",
         .help = "from bottom to top, along y",
         .unit = "m",
         .required = true,
         .range = kLength},
        {.name = "resolution",
         .type = Type::kInteger,
         .forms = {{2}},
         .help = "vertices around (at least 3) and from top to bottom",
         .required = true,
         .range = kVertices},
    }};
    return table;
}

const TableKeys& stretch_table() {
    static const TableKeys table{{
        {.name = "stiffness",
         .help = "of the spring along each edge",
         .unit = "N/m",
         .required = true,
         .range = positive()},
    }};
    return table;
}

const TableKeys& bend_table() {
    static const TableKeys table{{
        {.name = "stiffness",
         .help = "quadratic bending stiffness; 0: no bending",
         .unit = "J",
         .required = true,
         .range = at_least(0.0)},
    }};
    return table;
}

const TableKeys& pins_table() {
    static const TableKeys table{{
        {.name = "corners",
         .type = Type::kText,
         .forms = {{kAny}},
         .help = "corners of a grid",
         .choices = {"x-z-", "x+z-", "x-z+", "x+z+"}},
        {.name = "rims",
         .type = Type::kText,
         .forms = {{kAny}},
         .help = "rims of a cylinder",
         .choices = {"top", "bottom"}},
        {.name = "vertices",
         .type = Type::kInteger,
         .forms = {{kAny}},
         .help = "indices from 0, in the order of the mesh",
         .range = between(0, static_cast<double>(kMaxVertices - 1))},
        {.name = "box",
         .forms = {{2, 3}, {kAny, 2, 3}},
         .help = "all vertices that start inside [[low x, y, z], [high x, y, z]], or inside any of "
                 "a list of these",
         .unit = "m"},
        motion_key("carries the pinned vertices along; default: they stay where they are"),
    }};
    return table;
}

const TableKeys& cloth_table() {
    static const TableKeys table{
        .keys =
            {
                {.name = "name", .type = Type::kText, .help = "default: cloth0, cloth1, ..."},
                {.name = "grid",
                 .type = Type::kTable,
                 .help = "flat sheet in the x-z plane around the origin",
                 .table = &grid_table()},
                {.name = "cylinder",
                 .type = Type::kTable,
                 .help = "open side of a cone along y around the origin",
                 .table = &cylinder_table()},
                {.name = "mesh",
                 .type = Type::kText,
                 .help = "Wavefront OBJ file, relative to the scene file"},
                {.name = "scale",
                 .forms = {{}, {3}},
                 .help = "one factor, or one per axis",
                 .range = kLength},
                rotation_key(),
                {.name = "translate",
                 .forms = {{3}},
                 .help = "after scale and rotation",
                 .unit = "m",
                 .range = kPlace},
                {.name = "density",
                 .help = "mass per area",
                 .unit = "kg/m^2",
                 .required = true,
                 .range = positive_up_to(1e6)},
                {.name = "stretch",
                 .type = Type::kTable,
                 .help = "springs along the edges",
                 .required = true,
                 .table = &stretch_table()},
                {.name = "bend",
                 .type = Type::kTable,
                 .help = "bending over edges; default: no bending",
                 .table = &bend_table()},
                {.name = "damping",
                 .help = "rate at which velocities decay; default: no damping",
                 .unit = "1/s",
                 .range = between(0.0, 1e6)},
                {.name = "pins",
                 .type = Type::kTable,
                 .forms = {{}, {kAny}},
                 .help = "vertices that do not move freely, or a list of such groups",
                 .table = &pins_table()},
            },
        .exactly_one_of = {"grid", "cylinder", "mesh"},
    };
    return table;
}

TableKeys make_obstacle_table() {
    TableKeys table{
        .keys =
            {
                {.name = "name", .type = Type::kText, .help = "default: obstacle0, obstacle1, ..."},
                {.name = "shape",
                 .type = Type::kText,
                 .help = "form of the body",
                 .required = true,
                 .later_choices = {"mesh"}},
                {.name = "friction",
                 .help = "Coulomb coefficient; default: no friction",
                 .range = between(0.0, 100.0)},
                {.name = "thickness",
                 .help = "distance that cloth keeps from the surface",
                 .unit = "m",
                 .fallback = 0.0,
                 .range = between(0.0, 1e3)},
                motion_key("how it moves; default: it rests"),
            },
        .switch_key = "shape",
    };
    for (const ObstacleShape& shape : obstacle_shapes()) {
        table.keys[1].choices.push_back(shape.name);
        table.variants.push_back({shape.name, shape.keys});
    }
    return table;
}

const TableKeys& obstacle_table() {
    static const TableKeys table = make_obstacle_table();
    return table;
}

}  // namespace

const TableKeys& scene_keys() {
    static const TableKeys table{{
        {.name = "scene",
         .type = Type::kTable,
         .help = "what is simulated for how long",
         .required = true,
         .table = &scene_table()},
        {.name = "solver",
         .type = Type::kTable,
         .help = "how it is solved",
         .table = &solver_table(),
         .made_if_absent = true},
        {.name = "guard",
         .type = Type::kTable,
         .help = "when a state counts as exploded",
         .table = &guard_table(),
         .made_if_absent = true},
        {.name = "cloth",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "pieces of cloth",
         .required = true,
         .table = &cloth_table()},
        {.name = "obstacle",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "rigid bodies that cloth runs into",
         .table = &obstacle_table()},
        {.name = "solid",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "bodies of tetrahedra",
         .later = true},
        {.name = "contact",
         .type = Type::kTable,
         .help = "contact of cloth with itself and other cloth",
         .later = true},
    }};
    return table;
}

}  // namespace weft
