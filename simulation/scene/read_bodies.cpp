#include "simulation/scene/read_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>

#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/read_connections.h"
#include "simulation/scene/read_motion.h"
#include "simulation/scene/read_selection.h"
#include "simulation/scene/resolution.h"

namespace weft {
namespace {

template <class Number>
std::array<Number, 2> pair_of(const std::vector<Number>& values) {
    return {values.at(0), values.at(1)};
}

template <class Number>
std::array<Number, 3> triple_of(const std::vector<Number>& values) {
    return {values.at(0), values.at(1), values.at(2)};
}

CylinderShape read_cylinder(const Node& table) {
    CylinderShape shape{pair_of(number_values(table, "radius")), number_value(table, "height"),
                        pair_of(integer_values(table, "resolution"))};
    if (shape.resolution[0] < 3) {
        throw value_error(table, "resolution", "a cylinder needs at least 3 vertices around");
    }
    return shape;
}

std::string mesh_path(const Node& table, const std::string& scene_path,
                      std::string_view key = "mesh") {
    const std::string name = text_value(table, key);
    if (name.empty()) throw value_error(table, key, "expected the name of a mesh file");
    return (std::filesystem::path(scene_path).parent_path() / name).string();
}

Shape read_cloth_shape(const Node& table, const std::string& scene_path) {
    if (const Node* grid = table.find("grid")) {
        return GridShape{pair_of(number_values(*grid, "size")),
                         pair_of(integer_values(*grid, "resolution"))};
    }
    if (const Node* cylinder = table.find("cylinder")) return read_cylinder(*cylinder);
    MeshFile file{mesh_path(table, scene_path), {}, table.mark.text()};
    if (table.find("rest")) file.rest = mesh_path(table, scene_path, "rest");
    return file;
}

/// A pattern is as large as it is in its file, times one factor.
void check_rest(const Node& table, const Cloth& cloth) {
    if (!table.find("rest")) return;
    if (!std::holds_alternative<MeshFile>(cloth.shape)) {
        throw value_error(table, "rest", "only a mesh has a rest shape of its own");
    }
    const Vec3 scale = cloth.transform.scale;
    if (scale == Vec3{scale.x, scale.x, scale.x}) return;
    throw value_error(table, "scale",
                      "must be one factor, since the rest shape is scaled by it, too");
}

void check_outline(const Node& grid, const BlockShape& block) {
    const auto& rows = block.outline;
    bool is_empty = true;
    for (const std::string& row : rows) {
        if (row.empty() || row.size() != rows.front().size() ||
            row.find_first_not_of("#.") != std::string::npos) {
            throw value_error(grid, "outline", "expected rows of '#' and '.', all as long");
        }
        is_empty = is_empty && row.find('#') == std::string::npos;
    }
    if (is_empty) throw value_error(grid, "outline", "has no '#': nothing of the block is left");
    const std::array least = least_resolution(block);
    if (block.resolution[0] >= least[0] && block.resolution[1] >= least[1]) return;
    throw value_error(grid, "resolution",
                      fmt::format("the outline's {} x {} places need at least {} x {} vertices",
                                  least[0] - 1, least[1] - 1, least[0], least[1]));
}

BlockShape read_block(const Node& grid) {
    BlockShape block{triple_of(number_values(grid, "size")),
                     triple_of(integer_values(grid, "resolution")), text_values(grid, "outline")};
    if (grid.find("outline")) check_outline(grid, block);
    return block;
}

Shape read_solid_shape(const Node& table, const std::string& scene_path) {
    if (const Node* grid = table.find("grid")) return read_block(*grid);
    return MeshFile{mesh_path(table, scene_path), {}, table.mark.text()};
}

Transform read_transform(const Node& table) {
    Transform transform;
    if (const Node* scale = table.find("scale")) {
        if (scale->is_array()) {
            transform.scale = vec3_of(*scale);
        } else {
            const double factor = number_value(table, "scale");
            transform.scale = {factor, factor, factor};
        }
    }
    transform.rotations = rotation_values(table, "rotate");
    if (table.find("translate")) transform.translate = vec3_value(table, "translate");
    return transform;
}

std::vector<PinGroup> read_pins(const Node& table, const Shape& shape) {
    std::vector<PinGroup> groups;
    const Node* list = table.find("pins");
    if (!list) return groups;
    for (const Node& node : list->array()) {
        PinGroup pins;
        if (!has_selection(node)) {
            throw UserError(
                fmt::format("{}: pins: say which vertices: {}", node.mark.text(), kSelectionKeys));
        }
        read_selection(node, shape, pins);
        pins.motion = read_motion(node, Vec3{});
        if (names_any(pins)) groups.push_back(std::move(pins));
    }
    return groups;
}

Material read_material(const Node& table) {
    return {number_value(table, "young"), number_value(table, "poisson")};
}

/// What its triangles and edges are; something has to hold them together.
void read_elements(const Node& table, Cloth& cloth) {
    std::vector<std::string> holding;
    bool is_held = false;
    for (const ElementKeys& family : element_keys()) {
        if (family.read != nullptr) family.read(table, cloth);
        if (!family.holds_cloth) continue;
        holding.push_back(family.of_cloth.front().name);
        is_held = is_held || table.find(holding.back()) != nullptr;
    }
    if (is_held) return;
    throw value_error(
        table, holding.front(),
        fmt::format("is missing: a cloth needs one or more of {}", fmt::join(holding, ", ")));
}

/// Puts a body where its copy number n is.
void move_on(const Node& copies, int n, Transform& transform) {
    const std::vector<Rotation> turns = rotation_values(copies, "rotate");
    if (turns.size() > 1) throw value_error(copies, "rotate", "expected one turn for all copies");
    for (const Rotation& r : turns) transform.rotations.push_back({r.axis, n * r.degrees});
    transform.translate =
        transform.translate + static_cast<double>(n) * vec3_value(copies, "translate");
}

}  // namespace

template <class Body>
std::vector<Body> read_copies(const Node& table, const Body& body) {
    std::vector<Body> all{body};
    const Node* copies = table.find("copies");
    if (!copies) return all;
    for (int n = 1; n < integer_value(*copies, "count"); ++n) {
        Body& copy = all.emplace_back(body);
        copy.name = fmt::format("{}.{}", body.name, n);
        move_on(*copies, n, copy.transform);
    }
    return all;
}

template std::vector<Cloth> read_copies(const Node& table, const Cloth& body);
template std::vector<Solid> read_copies(const Node& table, const Solid& body);

Cloth read_cloth(const Node& table, const std::string& scene_path) {
    Cloth cloth;
    cloth.where = table.mark.text();
    cloth.shape = read_cloth_shape(table, scene_path);
    cloth.transform = read_transform(table);
    check_rest(table, cloth);
    cloth.density = number_value(table, "density");
    read_elements(table, cloth);
    cloth.damping = optional_number(table, "damping");
    cloth.pins = read_pins(table, cloth.shape);
    cloth.weld = truth_value(table, "weld");
    if (cloth.weld) require_weldable(table, cloth.shape);
    return cloth;
}

Solid read_solid(const Node& table, const std::string& scene_path) {
    Solid solid;
    solid.where = table.mark.text();
    solid.shape = read_solid_shape(table, scene_path);
    solid.transform = read_transform(table);
    solid.density = number_value(table, "density");
    solid.material = read_material(table);
    solid.damping = optional_number(table, "damping");
    solid.pins = read_pins(table, solid.shape);
    return solid;
}

MeshObstacle read_mesh_obstacle(const Node& table, const Scene& scene) {
    MeshObstacle obstacle;
    int shapes = 0;
    for (const char* key : {"mesh", "grid", "cylinder"}) shapes += table.find(key) ? 1 : 0;
    if (shapes != 1) {
        throw value_error(table, "shape",
                          fmt::format("needs exactly one of mesh, grid, cylinder, has {}", shapes));
    }
    obstacle.shape = read_cloth_shape(table, scene.path);
    obstacle.transform = read_transform(table);
    for (const char* key : {"friction", "thickness"}) {
        if (!optional_number(table, key)) continue;
        throw value_error(table, key, "a mesh has that of [contact]; leave it out");
    }
    const Node* motion = table.find("motion");
    if (!motion || !motion->find("frames")) {
        obstacle.motion = read_motion(table, obstacle.transform.translate);
        return obstacle;
    }
    for (const char* key : {"velocity", "angular_velocity", "keyframes", "center"}) {
        if (motion->find(key)) throw value_error(*motion, key, "cannot stand beside frames");
    }
    obstacle.frames = mesh_path(*motion, scene.path, "frames");
    obstacle.where = motion->find("frames")->mark.text();
    obstacle.frame_time = optional_number(*motion, "frame_time").value_or(scene.dt);
    return obstacle;
}

}  // namespace weft
