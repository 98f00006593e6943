#include "simulation/scene/read_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "simulation/scene/keys.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/scene/overrides.h"
#include "simulation/scene/resolution.h"
#include "simulation/scene/validate.h"

namespace weft {
namespace {

// A scene is a page of text; whatever is larger than this was meant for something else.
constexpr std::uintmax_t kMaxSceneBytes = 64U << 20U;

std::string read_text(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw UserError(path + ": no such scene file");
    if (std::filesystem::is_directory(status)) {
        throw UserError(path + ": is a folder, expected a scene file (.toml)");
    }
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (!error && bytes > kMaxSceneBytes) {
        throw UserError(fmt::format("{}: {} bytes are too many for a scene file", path, bytes));
    }
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (file) text << file.rdbuf();
    if (!file) throw UserError(path + ": cannot be read");
    return text.str();
}

/// A number that does nothing at 0 counts as not named.
std::optional<double> optional_number(const Node& table, std::string_view key) {
    if (!table.find(key) || number_value(table, key) == 0.0) return std::nullopt;
    return number_value(table, key);
}

// --- motion
// ---------------------------------------------------------------------------------------

void require_rising(const Node& table, std::string_view key, double before, double time) {
    if (time > before) return;
    throw value_error(table, key, fmt::format("times must rise, {} follows {}", time, before));
}

std::vector<MotionKey> read_motion_keys(const Node& table) {
    std::vector<MotionKey> keys;
    for (const Node& node : table.find("keyframes")->array()) {
        const MotionKey key{number_value(node, "time"), vec3_value(node, "translate"),
                            number_value(node, "rotate")};
        if (!keys.empty()) require_rising(node, "time", keys.back().time, key.time);
        keys.push_back(key);
    }
    return keys;
}

bool is_at_rest(const Motion& motion) {
    const auto still = [](const MotionKey& k) { return k.translate == Vec3{} && k.rotate == 0.0; };
    return motion.velocity == Vec3{} && motion.angular_velocity == 0.0 &&
           std::all_of(motion.keys.begin(), motion.keys.end(), still);
}

/// `center` is what the motion turns about unless it says otherwise.
std::optional<Motion> read_motion(const Node& owner, Vec3 center) {
    const Node* table = owner.find("motion");
    if (!table) return std::nullopt;
    Motion motion;
    motion.axis = direction_value(*table, "axis");
    motion.center = table->find("center") ? vec3_value(*table, "center") : center;
    if (table->find("velocity")) motion.velocity = vec3_value(*table, "velocity");
    if (table->find("angular_velocity")) {
        motion.angular_velocity = number_value(*table, "angular_velocity");
    }
    if (table->find("keyframes")) {
        if (table->find("velocity") || table->find("angular_velocity")) {
            throw value_error(*table, "keyframes", "cannot stand beside velocity; use one of them");
        }
        motion.keys = read_motion_keys(*table);
    }
    if (is_at_rest(motion)) return std::nullopt;
    return motion;
}

// --- cloth
// ----------------------------------------------------------------------------------------

template <class Number>
std::array<Number, 2> pair_of(const std::vector<Number>& values) {
    return {values.at(0), values.at(1)};
}

CylinderShape read_cylinder(const Node& table) {
    CylinderShape shape{pair_of(number_values(table, "radius")), number_value(table, "height"),
                        pair_of(integer_values(table, "resolution"))};
    if (shape.resolution[0] < 3) {
        throw value_error(table, "resolution", "a cylinder needs at least 3 vertices around");
    }
    return shape;
}

std::string mesh_path(const Node& table, const std::string& scene_path) {
    const std::string name = text_value(table, "mesh");
    if (name.empty()) throw value_error(table, "mesh", "expected the name of an OBJ file");
    return (std::filesystem::path(scene_path).parent_path() / name).string();
}

std::variant<GridShape, CylinderShape, MeshFile> read_shape(const Node& table,
                                                            const std::string& scene_path) {
    if (const Node* grid = table.find("grid")) {
        return GridShape{pair_of(number_values(*grid, "size")),
                         pair_of(integer_values(*grid, "resolution"))};
    }
    if (const Node* cylinder = table.find("cylinder")) return read_cylinder(*cylinder);
    return MeshFile{mesh_path(table, scene_path)};
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

PinGroup read_pin_group(const Node& table, const Cloth& cloth) {
    PinGroup pins;
    pins.where = table.mark.text();
    pins.corners = text_values(table, "corners");
    pins.rims = text_values(table, "rims");
    pins.vertices = integer_values(table, "vertices");
    pins.boxes = read_boxes(table);
    pins.motion = read_motion(table, Vec3{});
    if (!pins.corners.empty() && !std::holds_alternative<GridShape>(cloth.shape)) {
        throw value_error(table, "corners", "only a grid has corners; use vertices or box");
    }
    if (!pins.rims.empty() && !std::holds_alternative<CylinderShape>(cloth.shape)) {
        throw value_error(table, "rims", "only a cylinder has rims; use vertices or box");
    }
    return pins;
}

std::vector<PinGroup> read_pins(const Node& table, const Cloth& cloth) {
    std::vector<PinGroup> groups;
    const Node* list = table.find("pins");
    if (!list) return groups;
    for (const Node& node : list->array()) {
        PinGroup pins = read_pin_group(node, cloth);
        const bool names_any = !pins.corners.empty() || !pins.rims.empty() ||
                               !pins.vertices.empty() || !pins.boxes.empty();
        if (names_any) groups.push_back(std::move(pins));
    }
    return groups;
}

Cloth read_cloth(const Node& table, const std::string& scene_path) {
    Cloth cloth;
    cloth.where = table.mark.text();
    cloth.shape = read_shape(table, scene_path);
    cloth.transform = read_transform(table);
    cloth.density = number_value(table, "density");
    cloth.stretch.stiffness = number_value(*table.find("stretch"), "stiffness");
    if (const Node* bend = table.find("bend")) {
        if (const auto stiffness = optional_number(*bend, "stiffness"))
            cloth.bend = Bend{*stiffness};
    }
    cloth.damping = optional_number(table, "damping");
    cloth.pins = read_pins(table, cloth);
    return cloth;
}

// --- obstacles and the rest
// -----------------------------------------------------------------------

Obstacle read_obstacle(const Node& table) {
    Obstacle obstacle;
    obstacle.shape = text_value(table, "shape");
    for (const ObstacleShape& shape : obstacle_shapes()) {
        if (shape.name == obstacle.shape) shape.read(table, obstacle);
    }
    obstacle.friction = optional_number(table, "friction");
    obstacle.thickness = number_value(table, "thickness");
    obstacle.motion = read_motion(table, obstacle.frame.origin);
    return obstacle;
}

/// Names of output files and of paths in --set.
std::string read_name(const Node& table, const std::string& fallback) {
    const std::string name = table.find("name") ? text_value(table, "name") : fallback;
    const bool has_control = std::any_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    });
    if (name.empty() || name.size() > 200 || name == "." || name == ".." || has_control ||
        name.find_first_of("/\\") != std::string::npos) {
        throw value_error(table, "name",
                          "expected a name that can be a file's: not empty, up to "
                          "200 bytes, no slashes");
    }
    return name;
}

/// Reads every entry of [[key]] and gives it a name that no other has.
template <class Entry, class Read>
std::vector<Entry> read_entries(const Node& root, const std::string& key, Read read) {
    std::vector<Entry> entries;
    std::set<std::string> names;
    const Node* list = root.find(key);
    if (!list) return entries;
    for (const Node& table : list->array()) {
        Entry entry = read(table);
        entry.name = read_name(table, key + std::to_string(entries.size()));
        if (!names.insert(entry.name).second) {
            throw value_error(table, "name",
                              fmt::format("another {} has the name '{}'", key, entry.name));
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

std::vector<GravityKey> read_gravity_keys(const Node& table) {
    std::vector<GravityKey> keys;
    const Node* list = table.find("gravity_keyframes");
    if (!list) return keys;
    for (const Node& node : list->array()) {
        const std::vector<double> v = numbers_of(node);
        if (v[0] < 0.0) throw value_error(table, "gravity_keyframes", "times must not be negative");
        if (!keys.empty()) require_rising(table, "gravity_keyframes", keys.back().time, v[0]);
        keys.push_back({v[0], {v[1], v[2], v[3]}});
    }
    return keys;
}

void read_scene_table(const Node& table, Scene& scene) {
    const std::string stem = std::filesystem::path(scene.path).stem().string();
    scene.name = read_name(table, stem.empty() ? "scene" : stem);
    scene.frames = integer_value(table, "frames");
    scene.dt = number_value(table, "dt");
    scene.substeps = integer_value(table, "substeps");
    scene.gravity = vec3_value(table, "gravity");
    scene.gravity_keys = read_gravity_keys(table);
}

Scene read_document(const Node& root, const std::string& path) {
    Scene scene;
    scene.path = path;
    const Node& scene_table = *root.find("scene");
    read_scene_table(scene_table, scene);
    scene.solver.method = method_named(text_value(*root.find("solver"), "method"));
    scene.solver.iterations = integer_value(*root.find("solver"), "iterations");
    const Node& guard = *root.find("guard");
    scene.guard = {number_value(guard, "max_speed"), number_value(guard, "max_strain")};
    scene.cloths = read_entries<Cloth>(root, "cloth",
                                       [&](const Node& table) { return read_cloth(table, path); });
    scene.obstacles = read_entries<Obstacle>(root, "obstacle", read_obstacle);
    if (scene.cloths.empty()) throw value_error(root, "cloth", "a scene needs at least one cloth");
    if (scene_table.find("size")) {
        scale_resolutions(scene.cloths, integer_value(scene_table, "size"));
    }
    check_vertex_count(scene);
    return scene;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& path,
                  const std::vector<Override>& overrides) {
    Node root = parse_toml(text, path);
    apply_overrides(root, overrides);
    validate(root, scene_keys());
    Scene scene = read_document(root, path);
    scene.text = text;
    for (const Override& override_ : overrides) scene.overrides.push_back(override_.assignment);
    return scene;
}

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
    return parse_scene(read_text(path), path, overrides);
}

}  // namespace weft
