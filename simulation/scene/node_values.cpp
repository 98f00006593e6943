#include "simulation/scene/node_values.h"

#include <cassert>
#include <cmath>

#include <fmt/format.h>

namespace weft {
namespace {

// Shorter than this an axis says nothing about a direction, and its length underflows.
constexpr double kShortestAxis = 1e-12;

const Node& member(const Node& table, std::string_view key) {
    const Node* node = table.find(key);
    assert(node && "the check supplies required and defaulted keys");
    return *node;
}

double number_of(const Node& node) {
    const auto* integer = std::get_if<std::int64_t>(&node.value);
    return integer ? static_cast<double>(*integer) : std::get<double>(node.value);
}

int integer_of(const Node& node) { return static_cast<int>(std::get<std::int64_t>(node.value)); }

template <class Value, class Convert>
std::vector<Value> list_values(const Node& table, std::string_view key, Convert convert) {
    std::vector<Value> values;
    if (const Node* list = table.find(key)) {
        for (const Node& item : list->array()) values.push_back(convert(item));
    }
    return values;
}

}  // namespace

double number_value(const Node& table, std::string_view key) {
    return number_of(member(table, key));
}

std::optional<double> optional_number(const Node& table, std::string_view key) {
    if (!table.find(key) || number_value(table, key) == 0.0) return std::nullopt;
    return number_value(table, key);
}

bool truth_value(const Node& table, std::string_view key) {
    return std::get<bool>(member(table, key).value);
}

int integer_value(const Node& table, std::string_view key) {
    return integer_of(member(table, key));
}

std::string text_value(const Node& table, std::string_view key) {
    return std::get<std::string>(member(table, key).value);
}

std::vector<double> numbers_of(const Node& list) {
    std::vector<double> numbers;
    for (const Node& item : list.array()) numbers.push_back(number_of(item));
    return numbers;
}

std::vector<double> number_values(const Node& table, std::string_view key) {
    return list_values<double>(table, key, number_of);
}

std::vector<int> integer_values(const Node& table, std::string_view key) {
    return list_values<int>(table, key, integer_of);
}

std::vector<std::string> text_values(const Node& table, std::string_view key) {
    return list_values<std::string>(
        table, key, [](const Node& node) { return std::get<std::string>(node.value); });
}

Vec3 vec3_of(const Node& list) {
    const std::vector<double> v = numbers_of(list);
    return {v.at(0), v.at(1), v.at(2)};
}

Vec3 vec3_value(const Node& table, std::string_view key) { return vec3_of(member(table, key)); }

Vec3 direction_value(const Node& table, std::string_view key) {
    const Vec3 direction = vec3_value(table, key);
    if (length(direction) < kShortestAxis) {
        throw value_error(table, key, "must not be the zero vector, as [0, 1, 0]");
    }
    return direction;
}

Key rotation_key() {
    return {.name = "rotate",
            .forms = {{4}, {kAny, 4}},
            .help = "[axis x, axis y, axis z, degrees], or a list of these, one after the other"};
}

std::vector<Rotation> rotation_values(const Node& table, std::string_view key) {
    return list_values<Rotation>(table, key, [&](const Node& node) {
        const std::vector<double> v = numbers_of(node);
        const Vec3 axis{v.at(0), v.at(1), v.at(2)};
        if (length(axis) < kShortestAxis) {
            throw value_error(table, key,
                              "the axis (the first three numbers) must not be the zero vector");
        }
        return Rotation{axis, v.at(3)};
    });
}

UserError value_error(const Node& table, std::string_view key, const std::string& what) {
    const Node* node = table.find(key);
    const Mark& mark = node ? node->mark : table.mark;
    const std::string value = node ? " = " + node->describe() : "";
    return UserError(fmt::format("{}: {}{}: {}", mark.text(), key, value, what));
}

}  // namespace weft
