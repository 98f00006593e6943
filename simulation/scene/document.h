#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace weft {

/// Where a value was written: a place in a file, or the words of a command line.
struct Mark {
    std::string source;  ///< file, or "--set scene.frames=20"
    int line = 0;        ///< from 1; 0: not a file
    int column = 0;

    std::string text() const;  ///< "file:line:column" or just the source
};

struct Member;

/// One value of a TOML document, independent of the library that parsed it.
struct Node {
    using Array = std::vector<Node>;
    using Table = std::vector<Member>;
    /// TOML's dates and times, which no scene has a use for.
    struct Date {};

    using Value = std::variant<bool, std::int64_t, double, std::string, Date, Array, Table>;

    Value value;
    Mark mark;

    /// An empty table. What builds or ends a node is defined below, where a Member is complete.
    Node();
    Node(Value from, Mark at);
    Node(const Node&);
    Node(Node&&) noexcept;
    Node& operator=(const Node&);
    Node& operator=(Node&&) noexcept;
    ~Node();

    bool is_table() const { return std::holds_alternative<Table>(value); }
    bool is_array() const { return std::holds_alternative<Array>(value); }
    const Table& table() const { return std::get<Table>(value); }
    Table& table() { return std::get<Table>(value); }
    const Array& array() const { return std::get<Array>(value); }
    Array& array() { return std::get<Array>(value); }

    /// The member of a table, or null.
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);

    /// For messages: the value itself if it is short, "a table" and so on otherwise.
    std::string describe() const;
};

struct Member {
    std::string key;
    Mark mark;  ///< of the key
    Node value;
};

inline Node::Node() : value(Table{}) {}
inline Node::Node(Value from, Mark at) : value(std::move(from)), mark(std::move(at)) {}
inline Node::Node(const Node&) = default;
inline Node::Node(Node&&) noexcept = default;
inline Node& Node::operator=(const Node&) = default;
inline Node& Node::operator=(Node&&) noexcept = default;
inline Node::~Node() = default;

/// Parses a TOML text. Throws UserError with file, line and column.
Node parse_toml(const std::string& text, const std::string& path);

/// Parses one TOML value as given on a command line, where a bare word is a string.
/// `origin` becomes the source of all its marks. Throws UserError.
Node parse_toml_value(const std::string& text, const std::string& origin);

}  // namespace weft
