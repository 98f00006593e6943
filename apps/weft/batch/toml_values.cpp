#include "apps/weft/batch/toml_values.h"

#include <cmath>

#include "runtime/error.h"

namespace weft::batch {

namespace {

struct Converter {
    const Node& node;

    Value operator()(bool value) const { return value; }
    Value operator()(std::int64_t value) const { return value; }
    Value operator()(double value) const {
        if (!std::isfinite(value)) refuse();
        return value;
    }
    Value operator()(const std::string& value) const { return value; }
    Value operator()(const Node::Date&) const { refuse(); }
    Value operator()(const Node::Array& array) const {
        Value list = Value::array();
        for (const Node& item : array) list.push_back(to_json(item));
        return list;
    }
    Value operator()(const Node::Table& table) const {
        Value object = Value::object();
        for (const Member& member : table) object[member.key] = to_json(member.value);
        return object;
    }

    [[noreturn]] void refuse() const {
        throw UserError(node.mark.text() + ": " + node.describe() +
                        ": expected a finite number, a text, true or false, or lists of these");
    }
};

}  // namespace

Value to_json(const Node& node) { return std::visit(Converter{node}, node.value); }

std::string to_toml(const Value& value) {
    std::string text;
    if (value.is_object()) {
        for (const auto& [key, item] : value.items()) {
            text += (text.empty() ? "" : ", ") + Value(key).dump() + " = " + to_toml(item);
        }
        return "{ " + text + " }";
    }
    if (value.is_array()) {
        for (const Value& item : value) text += (text.empty() ? "" : ", ") + to_toml(item);
        return "[" + text + "]";
    }
    return value.dump();  // JSON's numbers, booleans and texts are TOML's, too
}

std::string to_text(const Value& value) {
    return value.is_string() ? value.get<std::string>() : to_toml(value);
}

}  // namespace weft::batch
