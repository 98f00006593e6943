#include "simulation/scene/document.h"

#include <fmt/format.h>

namespace weft {
namespace {

constexpr std::size_t kLongest = 60;

std::string describe_array(const Node::Array& array) {
    std::string text;
    for (const Node& item : array) {
        text += (text.empty() ? "" : ", ") + item.describe();
        if (text.size() > kLongest) return fmt::format("a list of {} values", array.size());
    }
    return "[" + text + "]";
}

struct Describe {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const { return fmt::format("{}", d); }
    std::string operator()(const std::string& s) const {
        if (s.size() > kLongest) return fmt::format("a string of {} bytes", s.size());
        return fmt::format("\"{}\"", s);
    }
    std::string operator()(Node::Date) const { return "a date or time"; }
    std::string operator()(const Node::Array& array) const { return describe_array(array); }
    std::string operator()(const Node::Table&) const { return "a table"; }
};

}  // namespace

std::string Mark::text() const {
    return line > 0 ? fmt::format("{}:{}:{}", source, line, column) : source;
}

const Node* Node::find(std::string_view key) const {
    if (!is_table()) return nullptr;
    for (const Member& member : table()) {
        if (member.key == key) return &member.value;
    }
    return nullptr;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

std::string Node::describe() const { return std::visit(Describe{}, value); }

}  // namespace weft
