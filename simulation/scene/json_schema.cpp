#include <algorithm>

#include <nlohmann/json.hpp>

#include "runtime/io/json_text.h"
#include "simulation/scene/keys.h"
#include "simulation/scene/read_scene.h"

namespace weft {
namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const TableKeys& keys);

void add_range(Json& schema, const Key& key) {
    const bool is_whole = key.type == Type::kInteger;
    const auto bound = [&](double x) {
        return is_whole ? Json(static_cast<std::int64_t>(x)) : Json(x);
    };
    const Range widest;
    if (key.range.low > widest.low) {
        schema[key.range.low_excluded ? "exclusiveMinimum" : "minimum"] = bound(key.range.low);
    }
    if (key.range.high < widest.high) {
        schema[key.range.high_excluded ? "exclusiveMaximum" : "maximum"] = bound(key.range.high);
    }
}

Json scalar_schema(const Key& key) {
    switch (key.type) {
        case Type::kTable:
            return table_schema(*key.table);
        case Type::kBoolean:
            return {{"type", "boolean"}};
        case Type::kText: {
            Json schema{{"type", "string"}};
            if (!key.choices.empty()) schema["enum"] = key.choices;
            return schema;
        }
        case Type::kInteger:
        case Type::kNumber:
            break;
    }
    Json schema{{"type", key.type == Type::kInteger ? "integer" : "number"}};
    add_range(schema, key);
    return schema;
}

Json form_schema(const Key& key, const Dims& dims) {
    Json schema = scalar_schema(key);
    for (auto length = dims.rbegin(); length != dims.rend(); ++length) {
        Json list{{"type", "array"}, {"items", std::move(schema)}};
        if (*length != kAny) {
            list["minItems"] = *length;
            list["maxItems"] = *length;
        }
        schema = std::move(list);
    }
    return schema;
}

Json key_schema(const Key& key) {
    Json schema;
    if (key.forms.size() == 1) {
        schema = form_schema(key, key.forms.front());
    } else {
        for (const Dims& dims : key.forms) schema["anyOf"].push_back(form_schema(key, dims));
    }
    const std::string unit = key.unit.empty() ? "" : " [" + key.unit + "]";
    schema["description"] = key.help + unit;
    if (!key.unit.empty()) schema["unit"] = key.unit;
    std::visit(
        [&](const auto& value) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) {
                schema["default"] = value;
            }
        },
        key.fallback);
    return schema;
}

void add_keys(Json& schema, const std::vector<Key>& keys) {
    for (const Key& key : keys) {
        schema["properties"][key.name] = key_schema(key);
        if (key.required) schema["required"].push_back(key.name);
    }
}

/// One closed object per value of the switch key: the keys of an obstacle depend on its shape.
Json variants_schema(const TableKeys& keys) {
    Json schema;
    for (const TableKeys::Variant& variant : keys.variants) {
        Json branch{{"type", "object"}};
        add_keys(branch, keys.keys);
        branch["properties"][keys.switch_key].erase("enum");
        branch["properties"][keys.switch_key]["const"] = variant.value;
        add_keys(branch, variant.keys);
        branch["additionalProperties"] = false;
        schema["oneOf"].push_back(std::move(branch));
    }
    return schema;
}

Json table_schema(const TableKeys& keys) {
    if (!keys.switch_key.empty()) return variants_schema(keys);
    Json schema{{"type", "object"}};
    add_keys(schema, keys.keys);
    for (const std::string& name : keys.exactly_one_of) {
        schema["oneOf"].push_back({{"required", {name}}});
    }
    schema["additionalProperties"] = false;
    return schema;
}

}  // namespace

std::string scene_json_schema() {
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", "Weft scene"}};
    schema.update(table_schema(scene_keys()));
    return json_text(schema);
}

}  // namespace weft
