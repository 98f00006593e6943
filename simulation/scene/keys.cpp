#include "simulation/scene/keys.h"

#include "simulation/scene/auto_method.h"
#include "simulation/scene/body_keys.h"
#include "simulation/scene/connection_keys.h"
#include "simulation/scene/limits.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/scene/scene.h"

namespace weft {
namespace {

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
         .help = "steps per frame; default: as many as meshes, iterations and gravity ask for",
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

std::vector<std::string> method_choices() {
    std::vector<std::string> names = method_names();
    names.emplace_back(kAutoMethod);
    return names;
}

const TableKeys& solver_table() {
    static const TableKeys table{{
        {.name = "method",
         .type = Type::kText,
         .help = "solver; auto: the one that is found to be the fastest for the scene",
         .fallback = std::string("xpbd"),
         .choices = method_choices()},
        {.name = "iterations",
         .type = Type::kInteger,
         .help =
             "iterations per substep; with method auto the most that it may take (left out: 64)",
         .fallback = std::int64_t{SolverSettings{}.iterations},
         .range = between(1, 1e5)},
        {.name = "tolerance",
         .help = "relative error of a step that will do, as estimated: fewer iterations where they "
                 "reach it; default: none",
         .range = {.low = 0.0, .high = 1.0, .low_excluded = true}},
        {.name = "cg_steps",
         .type = Type::kInteger,
         .help = "newton only: conjugate gradients per iteration, from the fourth iteration on",
         .fallback = std::int64_t{SolverSettings{}.cg_steps},
         .range = between(1, 1e4)},
        {.name = "sweeps",
         .type = Type::kInteger,
         .help = "newton only: sweeps of vertex block descent per iteration",
         .fallback = std::int64_t{SolverSettings{}.sweeps},
         .range = between(0, 1e2)},
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

const TableKeys& output_table() {
    static const TableKeys table{{
        {.name = "every",
         .type = Type::kInteger,
         .help = "geometry of every n-th frame is written, from the start on",
         .unit = "frames",
         .fallback = std::int64_t{OutputSettings{}.every},
         .range = between(1, 1e7)},
        {.name = "compression",
         .type = Type::kText,
         .help = "how much work goes into making the geometry small",
         .fallback = std::string(name_of(OutputSettings{}.compression)),
         .choices = compression_names()},
    }};
    return table;
}

const TableKeys& contact_table() {
    static const TableKeys table{{
        {.name = "self",
         .type = Type::kBoolean,
         .help = "bodies touch themselves, too, not only each other",
         .fallback = Contact{}.self},
        {.name = "thickness",
         .help = "distance of surfaces at which they begin to push each other apart; default: a "
                 "quarter of the mean edge",
         .unit = "m",
         .range = positive_up_to(1e3)},
        {.name = "friction",
         .help = "Coulomb coefficient; default: no friction",
         .range = between(0.0, 100.0)},
        {.name = "stiffness",
         .help = "of contacts, in units of what mass, time step and material make stiff in the "
                 "softest of the vertices that touch",
         .fallback = Contact{}.stiffness,
         .range = between(1e-3, 1e3)},
    }};
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
                 .required = true},
                {.name = "friction",
                 .help = "Coulomb coefficient; default: no friction",
                 .range = between(0.0, 100.0)},
                {.name = "thickness",
                 .help = "distance that cloth and solids keep from the surface",
                 .unit = "m",
                 .fallback = 0.0,
                 .range = between(0.0, 1e3)},
                motion_key("how it moves; default: it rests"),
                {.name = "parent",
                 .type = Type::kText,
                 .help = "an obstacle further up in the file that carries this one along"},
            },
        .switch_key = "shape",
    };
    for (const ObstacleShape& shape : obstacle_shapes()) {
        table.keys[1].choices.push_back(shape.name);
        table.variants.push_back({shape.name, shape.keys});
    }
    table.keys[1].choices.emplace_back("mesh");
    table.variants.push_back({"mesh", mesh_obstacle_keys()});
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
        {.name = "output",
         .type = Type::kTable,
         .help = "what a run leaves",
         .table = &output_table(),
         .made_if_absent = true},
        {.name = "cloth",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "pieces of cloth; a scene has at least one cloth or solid",
         .table = &cloth_table()},
        {.name = "solid",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "bodies of tetrahedra",
         .table = &solid_table()},
        {.name = "attachment",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "ties vertices of one cloth or solid to another",
         .table = &attachment_table()},
        {.name = "seam",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "sews edges of cloths together",
         .table = &seam_table()},
        {.name = "obstacle",
         .type = Type::kTable,
         .forms = {{kAny}},
         .help = "rigid bodies that cloth and solids run into",
         .table = &obstacle_table()},
        {.name = "contact",
         .type = Type::kTable,
         .help = "contact of cloth and solids with each other and with themselves; default: none",
         .table = &contact_table()},
    }};
    return table;
}

}  // namespace weft
