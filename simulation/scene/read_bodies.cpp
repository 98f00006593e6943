#include "simulation/scene/read_bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "runtime/near_miss.h"
#include "simulation/scene/elements/element_keys.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/read_motion.h"
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

std::vector<Box3> read_boxes(const Node& pins) {
    std::vector<Box3> boxes;
    const Node* list = pins.find("box");
    if (!list) return boxes;
    for (const Node& corners : list->array()) {
        const Box3 box{vec3_of(corners.array()[0]), vec3_of(corners.array()[1])};
        if (box.low.x > box.high.x || box.low.y > box.high.y || box.low.z > box.high.z) {
            throw value_error(pins, "box", "the first corner must be the lower one on every axis");
        }
        boxes.push_back(box);
    }
    return boxes;
}

/// Whether its corners and faces have names.
bool is_whole_block(const Shape& shape) {
    const auto* block = std::get_if<BlockShape>(&shape);
    return block != nullptr && block->outline.empty();
}

bool has_corner(const Shape& shape, const std::string& corner) {
    const bool is_of_block = corner.size() == 6;  // "x-y-z-", while a grid's are "x-z-"
    return is_of_block ? is_whole_block(shape) : std::holds_alternative<GridShape>(shape);
}

/// Which vertices of a body with that shape.
void read_selection(const Node& table, const Shape& shape, Selection& selection) {
    selection.where = table.mark.text();
    selection.corners = text_values(table, "corners");
    selection.edges = text_values(table, "edges");
    selection.rims = text_values(table, "rims");
    selection.faces = text_values(table, "faces");
    selection.parts = text_values(table, "parts");
    selection.vertices = integer_values(table, "vertices");
    selection.boxes = read_boxes(table);
    for (const std::string& corner : selection.corners) {
        if (!has_corner(shape, corner)) {
            throw value_error(table, "corners",
                              corner.size() == 6
                                  ? "only a solid's grid has such corners, and none with an "
                                    "outline; use vertices or box"
                                  : "only a grid has corners; use vertices or box");
        }
    }
    if (!selection.edges.empty() && !std::holds_alternative<GridShape>(shape)) {
        throw value_error(table, "edges", "only a cloth's grid has edges; use vertices or box");
    }
    if (!selection.rims.empty() && !std::holds_alternative<CylinderShape>(shape)) {
        throw value_error(table, "rims", "only a cylinder has rims; use vertices or box");
    }
    if (!selection.faces.empty() && !is_whole_block(shape)) {
        throw value_error(table, "faces",
                          "only a solid's grid has faces, and none with an outline; use "
                          "vertices or box");
    }
    if (!selection.parts.empty() && !std::holds_alternative<MeshFile>(shape)) {
        throw value_error(table, "parts",
                          "only a cloth's mesh file has parts; use vertices or box");
    }
}

constexpr const char* kSelectionKeys = "corners, edges, rims, faces, parts, vertices or box";

/// Also by a list that is empty: a sweep may have nothing selected in one of its runs.
bool has_selection(const Node& table) {
    constexpr std::array kKeys{"corners", "edges", "rims", "faces", "parts", "vertices", "box"};
    return std::ranges::any_of(kKeys, [&](const char* key) { return table.find(key) != nullptr; });
}

bool names_any(const Selection& selection) {
    return !selection.corners.empty() || !selection.edges.empty() || !selection.rims.empty() ||
           !selection.faces.empty() || !selection.parts.empty() || !selection.vertices.empty() ||
           !selection.boxes.empty();
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

const Shape* find_shape(const Scene& scene, const std::string& name) {
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.name == name) return &cloth.shape;
    }
    for (const Solid& solid : scene.solids) {
        if (solid.name == name) return &solid.shape;
    }
    return nullptr;
}

const Shape& named_shape(const Node& table, std::string_view key, const Scene& scene) {
    const std::string name = text_value(table, key);
    if (const Shape* shape = find_shape(scene, name)) return *shape;
    std::vector<std::string> names;
    for (const Cloth& cloth : scene.cloths) names.push_back(cloth.name);
    for (const Solid& solid : scene.solids) names.push_back(solid.name);
    throw value_error(table, key,
                      "no cloth or solid has this name; " + near_miss_or_list(name, names));
}

Attachment read_attachment(const Node& table, const Scene& scene) {
    Attachment attachment;
    attachment.where = table.mark.text();
    attachment.a = text_value(table, "a");
    attachment.b = text_value(table, "b");
    const Shape& shape = named_shape(table, "a", scene);
    named_shape(table, "b", scene);
    if (attachment.a == attachment.b) {
        throw value_error(table, "b", "must be another cloth or solid than a");
    }
    read_selection(table, shape, attachment.selected);
    if (!names_any(attachment.selected)) {
        throw value_error(table, "a", std::string("say which of its vertices: ") + kSelectionKeys);
    }
    attachment.stiffness = number_value(table, "stiffness");
    if (table.find("reach")) attachment.reach = number_value(table, "reach");
    return attachment;
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

const Cloth& named_cloth(const Node& table, const Scene& scene) {
    const std::string name = text_value(table, "cloth");
    std::vector<std::string> names;
    for (const Cloth& cloth : scene.cloths) {
        if (cloth.name == name) return cloth;
        names.push_back(cloth.name);
    }
    throw value_error(table, "cloth", "no cloth has this name; " + near_miss_or_list(name, names));
}

UserError no_mesh_to_weld(const Node& table) {
    return value_error(table, "weld",
                       "only a mesh file has several vertices in one place; leave it out");
}

SeamSide read_seam_side(const Node& table, const Scene& scene) {
    SeamSide side;
    const Cloth& cloth = named_cloth(table, scene);
    side.cloth = cloth.name;
    read_selection(table, cloth.shape, side.selected);
    if (names_any(side.selected)) return side;
    throw value_error(table, "cloth",
                      "say which of its vertices: edges, rims, parts, vertices or box");
}

/// Welding makes vertices of one mesh one, so that its triangles and folds go on over the seam.
void check_weld(const Node& table, const Seam& seam, const Scene& scene) {
    for (const char* key : {"stiffness", "time"}) {
        if (!table.find(key)) continue;
        throw value_error(table, key,
                          "cannot stand beside weld = true, which has no stitches; leave out "
                          "either");
    }
    if (seam.a.cloth != seam.b.cloth) {
        throw value_error(table, "weld",
                          fmt::format("joins edges of one cloth, and these are of '{}' and '{}'; "
                                      "put both into one mesh file, or leave weld out and give "
                                      "stiffness and time: then stitches hold them together",
                                      seam.a.cloth, seam.b.cloth));
    }
    const auto cloth = std::ranges::find(scene.cloths, seam.a.cloth, &Cloth::name);
    if (!std::holds_alternative<MeshFile>(cloth->shape)) throw no_mesh_to_weld(table);
}

Seam read_seam(const Node& table, const Scene& scene) {
    Seam seam{read_seam_side(*table.find("a"), scene), read_seam_side(*table.find("b"), scene), 0.0,
              0.0, table.mark.text()};
    if (truth_value(table, "weld")) {
        check_weld(table, seam, scene);
        return seam;
    }
    for (const char* key : {"stiffness", "time"}) {
        if (table.find(key)) continue;
        throw value_error(table, key, "is missing: a seam has stiffness and time, or weld = true");
    }
    seam.stiffness = number_value(table, "stiffness");
    seam.time = number_value(table, "time");
    return seam;
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
    if (cloth.weld && !std::holds_alternative<MeshFile>(cloth.shape)) throw no_mesh_to_weld(table);
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

std::vector<Attachment> read_attachments(const Node& root, const Scene& scene) {
    std::vector<Attachment> attachments;
    const Node* list = root.find("attachment");
    if (!list) return attachments;
    for (const Node& table : list->array()) attachments.push_back(read_attachment(table, scene));
    return attachments;
}

void read_seams(const Node& root, Scene& scene) {
    const Node* list = root.find("seam");
    if (!list) return;
    for (const Node& table : list->array()) {
        Seam seam = read_seam(table, scene);
        if (seam.time > 0.0) {
            scene.seams.push_back(std::move(seam));
            continue;
        }
        const auto cloth = std::ranges::find(scene.cloths, seam.a.cloth, &Cloth::name);
        cloth->welds.push_back(
            {std::move(seam.a.selected), std::move(seam.b.selected), std::move(seam.where)});
    }
}

}  // namespace weft
