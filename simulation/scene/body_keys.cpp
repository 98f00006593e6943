#include "simulation/scene/body_keys.h"

#include <algorithm>
#include <utility>

#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/selection_keys.h"

namespace weft {
namespace {

const Range kVertices = between(2, 1e6);

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

const TableKeys& block_table() {
    static const TableKeys table{{
        {.name = "size",
         .forms = {{3}},
         .help = "along x, y and z",
         .unit = "m",
         .required = true,
         .range = kLength},
        {.name = "resolution",
         .type = Type::kInteger,
         .forms = {{3}},
         .help = "vertices along x, y and z",
         .required = true,
         .range = kVertices},
        {.name = "outline",
         .type = Type::kText,
         .forms = {{kAny}},
         .help = "rows of a picture of the x-y side, from the top: only where it has a '#' the "
                 "block is there; '.' elsewhere. Default: all of it"},
    }};
    return table;
}

const TableKeys& copies_table() {
    static const TableKeys table{{
        {.name = "count",
         .type = Type::kInteger,
         .help = "how many there are, with the first; the others are called NAME.1, NAME.2, ...",
         .required = true,
         .range = between(1, 1e5)},
        {.name = "translate",
         .forms = {{3}},
         .help = "from each to the next",
         .unit = "m",
         .fallback = std::vector<double>{0, 0, 0},
         .range = kPlace},
        {.name = "rotate",
         .forms = {{4}, {kAny, 4}},
         .help = "[axis x, axis y, axis z, degrees]: each is turned so much more than the one "
                 "before"},
    }};
    return table;
}

const Key& copies_key() {
    static const Key key{.name = "copies",
                         .type = Type::kTable,
                         .help = "of the same body, each moved and turned on from the one before",
                         .table = &copies_table()};
    return key;
}

TableKeys pins_table(std::vector<Key> selection) {
    selection.push_back(
        motion_key("carries the pinned vertices along; default: they stay where they are"));
    return {std::move(selection)};
}

const TableKeys& cloth_pins_table() {
    static const TableKeys table = pins_table(cloth_selection_keys());
    return table;
}

const TableKeys& solid_pins_table() {
    static const TableKeys table = pins_table(solid_selection_keys());
    return table;
}

Key pins_key(const TableKeys& table) {
    return {.name = "pins",
            .type = Type::kTable,
            .forms = {{}, {kAny}},
            .help = "vertices that do not move freely, or a list of such groups",
            .table = &table};
}

// Placement, in the order in which it is applied.
const Key& scale_key() {
    static const Key key{.name = "scale",
                         .forms = {{}, {3}},
                         .help = "one factor, or one per axis",
                         .range = kLength};
    return key;
}

const Key& translate_key() {
    static const Key key{.name = "translate",
                         .forms = {{3}},
                         .help = "after scale and rotation",
                         .unit = "m",
                         .range = kPlace};
    return key;
}

const Key& damping_key() {
    static const Key key{.name = "damping",
                         .help = "rate at which velocities decay; default: no damping",
                         .unit = "1/s",
                         .range = between(0.0, 1e6)};
    return key;
}

TableKeys cloth_keys() {
    return {
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
                {.name = "rest",
                 .type = Type::kText,
                 .help = "of a mesh: OBJ file of its shape at rest, with the same faces (flat "
                         "panels, for example); default: the mesh as it is placed"},
                scale_key(),
                rotation_key(),
                translate_key(),
                copies_key(),
                {.name = "density",
                 .help = "mass per area",
                 .unit = "kg/m^2",
                 .required = true,
                 .range = positive_up_to(1e6)},
                damping_key(),
                pins_key(cloth_pins_table()),
                {.name = "weld",
                 .type = Type::kBoolean,
                 .help = "of a mesh: vertices of its border that lie in one place become one",
                 .fallback = false},
            },
        .exactly_one_of = {"grid", "cylinder", "mesh"},
    };
}

/// A solid of a lower ratio gives way under a compression that is no longer large (a fifth, from
/// all sides), and one of a higher ratio is more than 100 times as stiff against changes of volume
/// as against all else, which few sweeps over its vertices do not solve.
const Key& solid_poisson_key() {
    static const Key key{.name = "poisson",
                         .help = "Poisson's ratio: 0.5 would be incompressible",
                         .required = true,
                         .range = {.low = -0.5, .high = 0.495}};
    return key;
}

}  // namespace

const Key& young_key() {
    static const Key key{.name = "young",
                         .help = "Young's modulus",
                         .unit = "Pa",
                         .required = true,
                         .range = positive_up_to(1e15)};
    return key;
}

const Key& poisson_key() {
    static const Key key{
        .name = "poisson",
        .help = "Poisson's ratio: 0.5 would be incompressible",
        .required = true,
        .range = {.low = -1.0, .high = 0.5, .low_excluded = true, .high_excluded = true}};
    return key;
}

std::vector<Key> mesh_obstacle_keys() {
    return {{.name = "mesh",
             .type = Type::kText,
             .help = "Wavefront OBJ file, relative to the scene file; or grid, or cylinder"},
            {.name = "grid",
             .type = Type::kTable,
             .help = "flat sheet in the x-z plane around the origin",
             .table = &grid_table()},
            {.name = "cylinder",
             .type = Type::kTable,
             .help = "open side of a cone along y around the origin: a funnel",
             .table = &cylinder_table()},
            scale_key(),
            rotation_key(),
            translate_key()};
}

const TableKeys& cloth_table() {
    static const TableKeys table = [] {
        TableKeys cloth = cloth_keys();
        const auto density = std::ranges::find(cloth.keys, "density", &Key::name);
        std::vector<Key> elements;
        for (ElementKeys& family : element_keys()) {
            for (Key& key : family.of_cloth) elements.push_back(std::move(key));
        }
        cloth.keys.insert(density + 1, elements.begin(), elements.end());
        return cloth;
    }();
    return table;
}

const TableKeys& solid_table() {
    static const TableKeys table{
        .keys =
            {
                {.name = "name", .type = Type::kText, .help = "default: solid0, solid1, ..."},
                {.name = "grid",
                 .type = Type::kTable,
                 .help = "block around the origin, each cell cut into 6 tetrahedra",
                 .table = &block_table()},
                {.name = "mesh",
                 .type = Type::kText,
                 .help = "Gmsh (.msh) or legacy VTK (.vtk) file, relative to the scene file"},
                scale_key(),
                rotation_key(),
                translate_key(),
                copies_key(),
                {.name = "density",
                 .help = "mass per volume",
                 .unit = "kg/m^3",
                 .required = true,
                 .range = positive_up_to(1e6)},
                young_key(),
                solid_poisson_key(),
                damping_key(),
                pins_key(solid_pins_table()),
            },
        .exactly_one_of = {"grid", "mesh"},
    };
    return table;
}

}  // namespace weft
