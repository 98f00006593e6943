#include "simulation/scene/read_motion.h"

#include <algorithm>

#include <fmt/format.h>

#include "simulation/scene/node_values.h"

namespace weft {
namespace {

std::vector<MotionKey> read_motion_keys(const Node& table) {
    std::vector<MotionKey> keys;
    for (const Node& node : table.find("keyframes")->array()) {
        MotionKey key{number_value(node, "time"), vec3_value(node, "translate"),
                      number_value(node, "rotate"), std::nullopt};
        if (node.find("axis")) key.axis = direction_value(node, "axis");
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

}  // namespace

void require_rising(const Node& table, std::string_view key, double before, double time) {
    if (time > before) return;
    throw value_error(table, key, fmt::format("times must rise, {} follows {}", time, before));
}

std::optional<Motion> read_motion(const Node& owner, Vec3 center) {
    const Node* table = owner.find("motion");
    if (!table) return std::nullopt;
    for (const char* key : {"frames", "frame_time"}) {
        if (table->find(key)) {
            throw value_error(*table, key, "only an obstacle of shape = \"mesh\" has frames");
        }
    }
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

}  // namespace weft
