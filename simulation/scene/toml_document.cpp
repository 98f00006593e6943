// The only file that includes toml++, which is slow to compile.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "runtime/error.h"
#include "simulation/scene/document.h"

namespace weft {
namespace {

Mark mark_of(const toml::source_region& region, const std::string& source) {
    return {source, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Node convert(const toml::node& from, const std::string& source);

Node::Array convert_array(const toml::array& from, const std::string& source) {
    Node::Array array;
    array.reserve(from.size());
    for (const toml::node& item : from) array.push_back(convert(item, source));
    return array;
}

Node::Table convert_table(const toml::table& from, const std::string& source) {
    Node::Table table;
    for (const auto& [key, value] : from) {
        table.push_back(
            {std::string(key.str()), mark_of(key.source(), source), convert(value, source)});
    }
    return table;
}

Node convert(const toml::node& from, const std::string& source) {
    Node node;
    node.mark = mark_of(from.source(), source);
    if (const auto* table = from.as_table())
        node.value = convert_table(*table, source);
    else if (const auto* array = from.as_array())
        node.value = convert_array(*array, source);
    else if (const auto* text = from.as_string())
        node.value = text->get();
    else if (const auto* integer = from.as_integer())
        node.value = integer->get();
    else if (const auto* number = from.as_floating_point())
        node.value = number->get();
    else if (const auto* boolean = from.as_boolean())
        node.value = boolean->get();
    else
        node.value = Node::Date{};
    return node;
}

/// One line and without control characters, whatever the text was that broke the parser.
std::string one_line(std::string_view text) {
    std::string line(text);
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return std::iscntrl(static_cast<unsigned char>(c)); }, ' ');
    return line;
}

/// What needs no quotes on a command line: letters and digits of any alphabet, and a few others.
bool is_bare_word(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) || c >= 0x80 || c == '_' || c == '-' || c == '+' || c == '.' ||
               c == '/';
    });
}

toml::table parse_value(const std::string& text) { return toml::parse("value = " + text); }

/// The parser knows what is valid UTF-8.
bool is_utf8(const std::string& bare_word) {
    try {
        parse_value('"' + bare_word + '"');
        return true;
    } catch (const toml::parse_error&) {
        return false;
    }
}

[[noreturn]] void fail_value(const std::string& text, const std::string& origin,
                             std::string_view why) {
    const bool may_be_text =
        text.empty() || std::string_view("\"'[{").find(text[0]) == std::string_view::npos;
    throw UserError(fmt::format("{}: the value is not valid TOML: {}{}", origin, one_line(why),
                                may_be_text ? "; a text like this needs quotes: '\"...\"'" : ""));
}

void replace_marks(Node& node, const Mark& mark) {
    node.mark = mark;
    if (node.is_array()) {
        for (Node& item : node.array()) replace_marks(item, mark);
    } else if (node.is_table()) {
        for (Member& member : node.table()) {
            member.mark = mark;
            replace_marks(member.value, mark);
        }
    }
}

}  // namespace

Node parse_toml(const std::string& text, const std::string& path) {
    try {
        const toml::table root = toml::parse(text, path);
        Node node = convert(root, path);
        node.mark = {path, 1, 1};
        return node;
    } catch (const toml::parse_error& error) {
        throw UserError(fmt::format("{}: not valid TOML: {}", mark_of(error.source(), path).text(),
                                    one_line(error.description())));
    }
}

Node parse_toml_value(const std::string& text, const std::string& origin) {
    Node node;
    try {
        // A line break would let a value bring keys of its own along.
        if (text.find('\n') != std::string::npos) throw UserError(origin + ": one value, one line");
        const toml::table root = parse_value(text);
        node = convert(*root.get("value"), origin);
    } catch (const toml::parse_error& error) {
        if (!is_bare_word(text) || !is_utf8(text)) fail_value(text, origin, error.description());
        node.value = text;
    }
    replace_marks(node, {origin, 0, 0});
    return node;
}

}  // namespace weft
