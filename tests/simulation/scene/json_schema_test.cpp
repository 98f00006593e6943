#include <algorithm>
#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "simulation/scene/keys.h"
#include "simulation/scene/obstacle_shapes.h"
#include "simulation/scene/read_scene.h"

namespace weft {
namespace {

using nlohmann::json;

TEST(JsonSchema, DescribesTheWholeScene) {
    const json schema = json::parse(scene_json_schema());
    EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
    EXPECT_EQ(schema.at("additionalProperties"), false);
    for (const Key& key : scene_keys().keys) {
        EXPECT_TRUE(schema.at("properties").contains(key.name)) << key.name;
    }
}

TEST(JsonSchema, CarriesTypesRangesUnitsAndDefaults) {
    const json scene = json::parse(scene_json_schema()).at("properties").at("scene");
    const json& frames = scene.at("properties").at("frames");
    EXPECT_EQ(frames.at("type"), "integer");
    EXPECT_EQ(frames.at("minimum"), 1);
    const json& dt = scene.at("properties").at("dt");
    EXPECT_EQ(dt.at("exclusiveMinimum"), 0.0);
    EXPECT_EQ(dt.at("unit"), "s");
    const json& gravity = scene.at("properties").at("gravity");
    EXPECT_EQ(gravity.at("minItems"), 3);
    EXPECT_EQ(gravity.at("default"), json({0.0, -9.81, 0.0}));
    EXPECT_EQ(scene.at("required"), json({"frames", "dt"}));
}

TEST(JsonSchema, HasOneFormOfObstaclePerShape) {
    const json obstacle =
        json::parse(scene_json_schema()).at("properties").at("obstacle").at("items");
    std::vector<std::string> forms;
    for (const json& form : obstacle.at("oneOf")) {
        forms.push_back(form.at("properties").at("shape").at("const"));
    }
    std::vector<std::string> shapes;
    for (const ObstacleShape& shape : obstacle_shapes()) shapes.push_back(shape.name);
    shapes.emplace_back("mesh");
    EXPECT_EQ(forms, shapes);
    for (const char* promised : {"sphere", "plane", "capsule", "box", "mesh"}) {
        EXPECT_EQ(std::ranges::count(forms, promised), 1) << promised;
    }
}

TEST(JsonSchema, EveryKeyIsExplained) {
    const std::function<void(const json&)> visit = [&](const json& node) {
        if (!node.is_object()) return;
        if (const auto properties = node.find("properties"); properties != node.end()) {
            for (const auto& [name, key] : properties->items()) {
                EXPECT_FALSE(key.value("description", "").empty()) << name;
            }
        }
        for (const auto& [name, child] : node.items()) visit(child);
    };
    visit(json::parse(scene_json_schema()));
}

}  // namespace
}  // namespace weft
