#include "simulation/scene/overrides.h"

#include <charconv>
#include <span>

#include <fmt/format.h>

#include "runtime/error.h"

namespace weft {
namespace {

/// One step of a path: "cloth" or "[0]".
struct Step {
    std::string key;
    std::size_t index = 0;
    bool is_index = false;
};

struct Path {
    std::vector<Step> steps;
    std::string origin;
};

[[noreturn]] void fail(const std::string& origin, const std::string& what) {
    throw UserError(fmt::format("{}: {}", origin, what));
}

[[noreturn]] void fail_form(const std::string& origin) {
    fail(origin, "expected table.key=value, as in scene.frames=20 or cloth[0].density=0.3");
}

Step parse_index(std::string_view digits, const std::string& origin) {
    Step step;
    step.is_index = true;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), step.index);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) {
        fail(origin, fmt::format("[{}]: expected an index from 0", digits));
    }
    return step;
}

Path parse_path(std::string_view text, const std::string& origin) {
    Path path{{}, origin};
    while (true) {
        const std::size_t end = std::min(text.find_first_of(".["), text.size());
        if (end == 0) fail_form(origin);
        path.steps.push_back({std::string(text.substr(0, end)), 0, false});
        text.remove_prefix(end);
        while (!text.empty() && text.front() == '[') {
            const std::size_t close = text.find(']');
            if (close == std::string_view::npos) fail(origin, "']' is missing");
            path.steps.push_back(parse_index(text.substr(1, close - 1), origin));
            text.remove_prefix(close + 1);
        }
        if (text.empty()) return path;
        if (text.front() != '.') fail_form(origin);
        text.remove_prefix(1);
    }
}

void assign(Node& node, std::span<const Step> steps, const Node& value, const std::string& origin);

void assign_index(Node& node, std::span<const Step> steps, const Node& value,
                  const std::string& origin) {
    const std::size_t index = steps.front().index;
    if (!node.is_array()) fail(origin, fmt::format("[{}]: there is no list here", index));
    if (index >= node.array().size()) {
        fail(origin, fmt::format("[{}]: the list has {} entries, counted from 0", index,
                                 node.array().size()));
    }
    assign(node.array()[index], steps.subspan(1), value, origin);
}

bool has_name(const Node& node, const std::string& name) {
    const Node* found = node.find("name");
    const auto* text = found ? std::get_if<std::string>(&found->value) : nullptr;
    return text && *text == name;
}

/// "cloth.sheet.density": the entry of that name; "cloth.density": every entry.
void assign_entries(Node::Array& entries, std::span<const Step> steps, const Node& value,
                    const std::string& origin) {
    for (Node& entry : entries) {
        if (steps.size() > 1 && has_name(entry, steps.front().key)) {
            return assign(entry, steps.subspan(1), value, origin);
        }
    }
    if (entries.empty()) fail(origin, fmt::format("no entry to set '{}' in", steps.front().key));
    for (Node& entry : entries) assign(entry, steps, value, origin);
}

void assign_key(Node& node, std::span<const Step> steps, const Node& value,
                const std::string& origin) {
    const std::string& key = steps.front().key;
    if (!node.is_table()) {
        fail(origin, fmt::format("'{}' cannot be set inside {}", key, node.describe()));
    }
    Node* child = node.find(key);
    if (!child) {
        const Mark mark{origin, 0, 0};
        node.table().push_back({key, mark, Node{Node::Table{}, mark}});
        child = &node.table().back().value;
    }
    assign(*child, steps.subspan(1), value, origin);
}

void assign(Node& node, std::span<const Step> steps, const Node& value, const std::string& origin) {
    if (steps.empty())
        node = value;
    else if (steps.front().is_index)
        assign_index(node, steps, value, origin);
    else if (node.is_array())
        assign_entries(node.array(), steps, value, origin);
    else
        assign_key(node, steps, value, origin);
}

}  // namespace

void apply_overrides(Node& root, const std::vector<Override>& overrides) {
    for (const Override& override_ : overrides) {
        const std::string& text = override_.assignment;
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0) fail_form(override_.origin);
        const Path path = parse_path(std::string_view(text).substr(0, equals), override_.origin);
        const Node value = parse_toml_value(text.substr(equals + 1), override_.origin);
        assign(root, path.steps, value, override_.origin);
    }
}

}  // namespace weft
