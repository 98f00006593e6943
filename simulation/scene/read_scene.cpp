#include "simulation/scene/read_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <span>
#include <sstream>

#include <fmt/format.h>

#include "runtime/near_miss.h"
#include "simulation/scene/auto_method.h"
#include "simulation/scene/keys.h"
#include "simulation/scene/node_values.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/scene/overrides.h"
#include "simulation/scene/read_bodies.h"
#include "simulation/scene/read_connections.h"
#include "simulation/scene/read_motion.h"
#include "simulation/scene/resolution.h"
#include "simulation/scene/solver_limits.h"
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

void take_name(const Node& table, const std::string& name, std::string_view what,
               std::set<std::string>& names) {
    if (names.insert(name).second) return;
    throw value_error(table, "name", fmt::format("another {} has the name '{}'", what, name));
}

/// Reads every entry of [[key]] and gives it a name that none of `names` has.
template <class Entry, class Read>
std::vector<Entry> read_entries(const Node& root, const std::string& key,
                                std::set<std::string>& names, Read read) {
    std::vector<Entry> entries;
    const Node* list = root.find(key);
    if (!list) return entries;
    for (const Node& table : list->array()) {
        Entry entry = read(table);
        entry.name = read_name(table, key + std::to_string(entries.size()));
        take_name(table, entry.name, key == "obstacle" ? "obstacle" : "cloth or solid", names);
        entries.push_back(std::move(entry));
    }
    return entries;
}

/// The same, each followed by its copies.
template <class Body, class Read>
std::vector<Body> read_bodies(const Node& root, const std::string& key,
                              std::set<std::string>& names, Read read) {
    std::vector<Body> all;
    const std::vector<Body> written = read_entries<Body>(root, key, names, read);
    for (std::size_t i = 0; i < written.size(); ++i) {
        const Body& first = written[i];
        const Node& table = root.find(key)->array()[i];
        for (Body& body : read_copies(table, first)) {
            if (body.name != first.name) take_name(table, body.name, "cloth or solid", names);
            all.push_back(std::move(body));
        }
    }
    return all;
}

/// One entry of [[obstacle]], of either kind.
struct AnyObstacle {
    std::string name{};
    std::optional<Obstacle> convex{};
    std::optional<MeshObstacle> mesh{};

    std::optional<Motion>& motion() { return convex ? convex->motion : mesh->motion; }
};

AnyObstacle read_any_obstacle(const Node& table, const Scene& scene) {
    AnyObstacle any;
    if (text_value(table, "shape") == "mesh") {
        any.mesh = read_mesh_obstacle(table, scene);
    } else {
        any.convex = read_obstacle(table);
    }
    return any;
}

/// Gives an obstacle the motion of its parent, one of those before it.
void adopt(const Node& table, std::span<AnyObstacle> before, AnyObstacle& child) {
    const std::string name = text_value(table, "parent");
    const auto parent = std::ranges::find(before, name, &AnyObstacle::name);
    if (parent == before.end()) {
        std::vector<std::string> names;
        for (const AnyObstacle& other : before) names.push_back(other.name);
        throw value_error(table, "parent",
                          names.empty() ? "no obstacle stands further up"
                                        : "no obstacle further up has this name; " +
                                              near_miss_or_list(name, names));
    }
    for (const AnyObstacle* any : {&*parent, &child}) {
        if (any->mesh && !any->mesh->frames.empty()) {
            throw value_error(table, "parent", any->name + " moves by frames, which has no parts");
        }
    }
    if (!parent->motion()) return;
    Motion motion = child.motion().value_or(Motion{});
    motion.parent = std::make_shared<const Motion>(*parent->motion());
    child.motion() = std::move(motion);
}

void read_obstacles(const Node& root, const std::set<std::string>& body_names, Scene& scene) {
    std::set<std::string> names;
    std::vector<AnyObstacle> list = read_entries<AnyObstacle>(
        root, "obstacle", names,
        [&](const Node& table) { return read_any_obstacle(table, scene); });
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Node& table = root.find("obstacle")->array()[i];
        if (table.find("parent")) adopt(table, std::span(list).first(i), list[i]);
        if (list[i].mesh && !scene.contact) {
            throw value_error(table, "shape", "is touched by [contact] alone: add that table");
        }
        if (list[i].mesh && body_names.contains(list[i].name)) {
            throw value_error(table, "name", "a cloth or solid has that name");
        }
    }
    for (AnyObstacle& any : list) {
        if (any.convex) {
            any.convex->name = any.name;
            scene.obstacles.push_back(std::move(*any.convex));
        } else {
            any.mesh->name = any.name;
            scene.mesh_obstacles.push_back(std::move(*any.mesh));
        }
    }
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
    if (table.find("substeps")) scene.substeps = integer_value(table, "substeps");
    scene.gravity = vec3_value(table, "gravity");
    scene.gravity_keys = read_gravity_keys(table);
}

SolverSettings read_solver(const Node& table) {
    SolverSettings solver;
    // Of one that is to be chosen yet, settings are the defaults.
    const std::string method = text_value(table, "method");
    if (method != kAutoMethod) solver.method = method_named(method);
    solver.iterations = integer_value(table, "iterations");
    if (table.find("tolerance")) solver.tolerance = number_value(table, "tolerance");
    solver.cg_steps = integer_value(table, "cg_steps");
    solver.sweeps = integer_value(table, "sweeps");
    if (const int most = most_iterations(solver); solver.iterations > most) {
        throw value_error(table, "iterations",
                          fmt::format("{} takes at most {} with cg_steps = {}",
                                      name_of(solver.method), most, solver.cg_steps));
    }
    return solver;
}

std::optional<Contact> read_contact(const Node& root) {
    const Node* table = root.find("contact");
    if (!table) return std::nullopt;
    Contact contact;
    contact.self = truth_value(*table, "self");
    contact.thickness = optional_number(*table, "thickness").value_or(0.0);
    contact.friction = optional_number(*table, "friction");
    contact.stiffness = number_value(*table, "stiffness");
    return contact;
}

/// One that nothing follows is refused: a sweep over it would do the same run again and again.
void read_size(const Node& table, Scene& scene) {
    if (scale_resolutions(scene, integer_value(table, "size"))) return;
    const Node& size = *table.find("size");
    throw UserError(fmt::format(
        "{}: scene.size = {}: no cloth or solid of the scene is a grid or a cylinder, whose "
        "resolutions it scales; a mesh file has the vertices that it has: leave it out",
        size.mark.text(), size.describe()));
}

Scene read_document(const Node& root, const std::string& path) {
    Scene scene;
    scene.path = path;
    const Node& scene_table = *root.find("scene");
    read_scene_table(scene_table, scene);
    scene.solver = read_solver(*root.find("solver"));
    const Node& guard = *root.find("guard");
    scene.guard = {number_value(guard, "max_speed"), number_value(guard, "max_strain")};
    const Node& output = *root.find("output");
    scene.output = {integer_value(output, "every"),
                    compression_named(text_value(output, "compression"))};
    std::set<std::string> names;
    scene.cloths = read_bodies<Cloth>(root, "cloth", names,
                                      [&](const Node& table) { return read_cloth(table, path); });
    scene.solids = read_bodies<Solid>(root, "solid", names,
                                      [&](const Node& table) { return read_solid(table, path); });
    scene.contact = read_contact(root);
    read_obstacles(root, names, scene);
    scene.attachments = read_attachments(root, scene);
    read_seams(root, scene);
    if (scene.cloths.empty() && scene.solids.empty()) {
        throw UserError(path + ": a scene needs at least one [[cloth]] or [[solid]]");
    }
    if (scene_table.find("size")) read_size(scene_table, scene);
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
