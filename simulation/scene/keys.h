#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

/// The description of scene files: one table from which the check (validate.h), the defaults and
/// the JSON Schema (json_schema.cpp) follow, so that they cannot drift apart.
namespace weft {

/// Allowed values of every number in a value; bounds included unless said otherwise. What is beyond
/// the widest range overflows or vanishes in the kernels' single precision.
struct Range {
    double low = -1e20;
    double high = 1e20;
    bool low_excluded = false;
    bool high_excluded = false;
};

constexpr Range at_least(double low) { return {.low = low}; }
constexpr Range between(double low, double high) { return {.low = low, .high = high}; }
constexpr Range positive() { return {.low = 0.0, .low_excluded = true}; }
constexpr Range positive_up_to(double high) {
    return {.low = 0.0, .high = high, .low_excluded = true};
}

enum class Type { kBoolean, kInteger, kNumber, kText, kTable };

/// Lengths of nested lists from the outside in; {} is a plain value, {3} a list of three,
/// {kAny, 3} a list of any number of lists of three.
using Dims = std::vector<int>;
constexpr int kAny = -1;

using Default =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>>;

struct TableKeys;

struct Key {
    std::string name;
    Type type = Type::kNumber;
    /// Accepted forms, told apart by their depth, shallow ones first. Where there are two of which
    /// the second is a list of the first, the check turns the first into a list of one.
    std::vector<Dims> forms{{}};
    std::string help{};
    std::string unit{};
    bool required = false;
    Default fallback{};                  ///< absent: the thing itself is absent
    Range range{};                       ///< of numbers
    std::vector<std::string> choices{};  ///< of texts; empty: any text
    const TableKeys* table = nullptr;    ///< of Type::kTable
    bool made_if_absent = false;         ///< a table with defaults for all that it needs
};

/// The keys of one table.
struct TableKeys {
    std::vector<Key> keys{};
    std::vector<std::string> exactly_one_of{};  ///< of these keys, exactly one must be there
    /// Keys that only go with one value of the text key `switch_key` (an obstacle's shape).
    struct Variant {
        std::string value;
        std::vector<Key> keys;
    };
    std::string switch_key{};
    std::vector<Variant> variants{};
};

/// The whole of a scene file.
const TableKeys& scene_keys();

}  // namespace weft
