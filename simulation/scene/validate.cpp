#include "simulation/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/error.h"
#include "runtime/near_miss.h"

namespace weft {
namespace {

// Smaller numbers than this vanish in single precision once they are squared.
constexpr double kSmallest = 1e-20;

[[noreturn]] void fail(const Node& node, const std::string& path, const std::string& what) {
    throw UserError(fmt::format("{}: {} = {}: {}", node.mark.text(), path, node.describe(), what));
}

std::string joined(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
}

// --- what a value should be, in words -----------------------------------------------------------

std::string scalar_words(Type type, bool plural) {
    switch (type) {
        case Type::kBoolean:
            return plural ? "truth values" : "true or false";
        case Type::kInteger:
            return plural ? "integers" : "an integer";
        case Type::kNumber:
            return plural ? "numbers" : "a number";
        case Type::kText:
            return plural ? "strings" : "a string";
        case Type::kTable:
            return plural ? "tables" : "a table";
    }
    return "";
}

std::string form_words(Type type, std::span<const int> dims, bool plural) {
    if (dims.empty()) return scalar_words(type, plural);
    const std::string inner = form_words(type, dims.subspan(1), true);
    const std::string list = plural ? "lists" : "a list";
    return dims.front() == kAny ? fmt::format("{} of {}", list, inner)
                                : fmt::format("{} of {} {}", list, dims.front(), inner);
}

std::string expected(const Key& key) {
    std::vector<std::string> forms;
    for (const Dims& dims : key.forms) forms.push_back(form_words(key.type, dims, false));
    const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
    return fmt::format("expected {}{}", fmt::join(forms, " or "), unit);
}

// --- plain values
// ---------------------------------------------------------------------------------

void check_range(const Node& node, const Key& key, const std::string& path, double value) {
    const Range& range = key.range;
    const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
    if (!std::isfinite(value)) fail(node, path, "must be a finite number" + unit);
    if (range.low_excluded ? value <= range.low : value < range.low) {
        const char* word = range.low_excluded ? "greater than" : "at least";
        fail(node, path, fmt::format("must be {} {}{}", word, range.low, unit));
    }
    if (range.high_excluded ? value >= range.high : value > range.high) {
        const char* word = range.high_excluded ? "less than" : "at most";
        fail(node, path, fmt::format("must be {} {}{}", word, range.high, unit));
    }
    if (value != 0.0 && std::abs(value) < kSmallest) {
        fail(node, path, fmt::format("too small for single precision (below {})", kSmallest));
    }
}

void check_number(const Node& node, const Key& key, const std::string& path) {
    if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
        return check_range(node, key, path, static_cast<double>(*integer));
    }
    const auto* number = std::get_if<double>(&node.value);
    if (!number) fail(node, path, expected(key));
    // As a number is shown, it may look like the integer that it is none of.
    if (key.type == Type::kInteger) fail(node, path, expected(key) + ", without a point");
    check_range(node, key, path, *number);
}

void check_int32(const Node& node, const Key& key, const std::string& path) {
    constexpr std::int64_t kLimit = std::numeric_limits<std::int32_t>::max();
    check_number(node, key, path);
    const std::int64_t value = std::get<std::int64_t>(node.value);
    if (value > kLimit || value < -kLimit) {
        fail(node, path, fmt::format("must be at most {}", kLimit));
    }
}

void check_text(const Node& node, const Key& key, const std::string& path) {
    const auto* text = std::get_if<std::string>(&node.value);
    if (!text) fail(node, path, expected(key));
    if (!key.choices.empty() && std::ranges::count(key.choices, *text) == 0) {
        fail(node, path, "unknown; " + near_miss_or_list(*text, key.choices));
    }
}

// --- tables and lists
// -----------------------------------------------------------------------------

void check_table(Node& node, const TableKeys& keys, const std::string& path);

void check_scalar(Node& node, const Key& key, const std::string& path) {
    switch (key.type) {
        case Type::kBoolean:
            if (!std::holds_alternative<bool>(node.value)) fail(node, path, expected(key));
            return;
        case Type::kInteger:
            return check_int32(node, key, path);
        case Type::kNumber:
            return check_number(node, key, path);
        case Type::kText:
            return check_text(node, key, path);
        case Type::kTable:
            if (!node.is_table()) fail(node, path, expected(key));
            return check_table(node, *key.table, path);
    }
}

void check_form(Node& node, const Key& key, std::span<const int> dims, const std::string& path) {
    if (dims.empty()) return check_scalar(node, key, path);
    if (!node.is_array()) fail(node, path, expected(key));
    Node::Array& items = node.array();
    if (dims.front() != kAny && items.size() != static_cast<std::size_t>(dims.front())) {
        fail(node, path, fmt::format("{}, got {}", expected(key), items.size()));
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
        check_form(items[i], key, dims.subspan(1), fmt::format("{}[{}]", path, i));
    }
}

std::size_t depth_of(const Node& node) {
    std::size_t depth = 0;
    for (const Node* at = &node; at->is_array(); at = &at->array().front()) {
        ++depth;
        if (at->array().empty()) break;
    }
    return depth;
}

void check_value(Node& node, const Key& key, const std::string& path) {
    const std::size_t depth = depth_of(node);
    const bool is_empty_list = node.is_array() && node.array().empty();
    const Dims* form = &key.forms.back();
    for (const Dims& dims : key.forms) {
        if (dims.size() == depth && !is_empty_list) form = &dims;
    }
    check_form(node, key, *form, path);
    const Dims& last = key.forms.back();
    if (form != &last && last.front() == kAny) {
        Node list{Node::Array{}, node.mark};
        list.array().push_back(std::move(node));
        node = std::move(list);
    }
}

Node default_node(const Default& fallback, const Mark& mark) {
    Node node;
    node.mark = mark;
    if (const auto* truth = std::get_if<bool>(&fallback)) node.value = *truth;
    if (const auto* integer = std::get_if<std::int64_t>(&fallback)) node.value = *integer;
    if (const auto* number = std::get_if<double>(&fallback)) node.value = *number;
    if (const auto* text = std::get_if<std::string>(&fallback)) node.value = *text;
    if (const auto* list = std::get_if<std::vector<double>>(&fallback)) {
        node.value = Node::Array{};
        for (const double number : *list) node.array().push_back({number, mark});
    }
    return node;
}

void check_presence(Node& table, const Key& key, const std::string& path) {
    if (table.find(key.name)) return;
    if (key.required) {
        const std::string help = key.help.empty() ? "" : fmt::format(" ({})", key.help);
        throw UserError(fmt::format("{}: {} is missing: {}{}", table.mark.text(),
                                    joined(path, key.name), expected(key), help));
    }
    if (key.made_if_absent) {
        table.table().push_back({key.name, table.mark, Node{Node::Table{}, table.mark}});
    } else if (!std::holds_alternative<std::monostate>(key.fallback)) {
        table.table().push_back({key.name, table.mark, default_node(key.fallback, table.mark)});
    }
}

void check_exactly_one(const Node& table, const TableKeys& keys, const std::string& path) {
    const auto& names = keys.exactly_one_of;
    const auto present = std::count_if(names.begin(), names.end(),
                                       [&](const std::string& name) { return table.find(name); });
    if (names.empty() || present == 1) return;
    throw UserError(fmt::format("{}: {}: needs exactly one of {}, has {}", table.mark.text(), path,
                                fmt::join(names, ", "), present));
}

/// The table's own keys and those of the variant that its switch key chooses.
std::vector<const Key*> keys_in_force(Node& table, const TableKeys& keys, const std::string& path) {
    std::vector<const Key*> list;
    for (const Key& key : keys.keys) list.push_back(&key);
    if (keys.switch_key.empty()) return list;
    for (const Key& key : keys.keys) {
        if (key.name != keys.switch_key) continue;
        check_presence(table, key, path);
        check_value(*table.find(key.name), key, joined(path, key.name));
    }
    const std::string& chosen = std::get<std::string>(table.find(keys.switch_key)->value);
    for (const TableKeys::Variant& variant : keys.variants) {
        if (variant.value != chosen) continue;
        for (const Key& key : variant.keys) list.push_back(&key);
    }
    return list;
}

const Key* known_key(const std::vector<const Key*>& keys, const Member& member,
                     const std::string& path) {
    std::vector<std::string> names;
    for (const Key* key : keys) {
        if (key->name == member.key) return key;
        names.push_back(key->name);
    }
    throw UserError(fmt::format("{}: unknown key '{}'{}; {}", member.mark.text(), member.key,
                                path.empty() ? "" : " in " + path,
                                near_miss_or_list(member.key, names)));
}

void check_table(Node& node, const TableKeys& keys, const std::string& path) {
    const std::vector<const Key*> in_force = keys_in_force(node, keys, path);
    for (Member& member : node.table()) {
        const Key* key = known_key(in_force, member, path);
        // The switch key has been checked, to know which keys there are.
        if (key->name != keys.switch_key) check_value(member.value, *key, joined(path, key->name));
    }
    for (const Key* key : in_force) check_presence(node, *key, path);
    for (const Key* key : in_force) {
        if (key->made_if_absent) check_table(*node.find(key->name), *key->table, key->name);
    }
    check_exactly_one(node, keys, path);
}

}  // namespace

void validate(Node& root, const TableKeys& keys) { check_table(root, keys, ""); }

}  // namespace weft
