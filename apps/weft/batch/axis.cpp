#include "apps/weft/batch/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/weft/batch/sweep_tables.h"
#include "runtime/error.h"

namespace weft::batch {

namespace {

std::vector<std::string> read_keys(const Node& table) {
    const Node* one = table.find("key");
    const Node* several = table.find("keys");
    if ((one == nullptr) == (several == nullptr)) {
        throw UserError(table.mark.text() +
                        ": an [[axis]] needs either 'key' or 'keys' (or a table)");
    }
    if (one != nullptr) return {text_of(*one, "key")};
    if (!several->is_array() || several->array().empty()) {
        fail(*several, "keys", "expected a list of keys");
    }
    std::vector<std::string> keys;
    for (const Node& node : several->array()) keys.push_back(text_of(node, "keys"));
    return keys;
}

std::vector<Setting> one_step(const std::vector<std::string>& keys, const Node& value) {
    if (keys.size() == 1) return {{keys.front(), to_json(value), value.mark}};
    if (!value.is_array() || value.array().size() != keys.size()) {
        fail(value, "values",
             fmt::format("expected a list of {} values, one per key", keys.size()));
    }
    std::vector<Setting> step;
    for (std::size_t k = 0; k < keys.size(); ++k) {
        step.push_back({keys[k], to_json(value.array()[k]), value.array()[k].mark});
    }
    return step;
}

Axis read_values(const Node& table, const Node& values) {
    Axis axis{read_keys(table), {}};
    if (!values.is_array() || values.array().empty()) {
        fail(values, "values", "expected a list of values");
    }
    for (const Node& value : values.array()) axis.steps.push_back(one_step(axis.keys, value));
    return axis;
}

double number_of(const Node& range, const std::string& key) {
    const Node& node = required(range, key);
    if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
        return static_cast<double>(*integer);
    }
    const auto* number = std::get_if<double>(&node.value);
    if (number == nullptr || !std::isfinite(*number)) fail(node, key, "expected a number");
    return *number;
}

bool is_logarithmic(const Node& range, double from, double to) {
    const Node* scale = range.find("scale");
    const std::string name = scale ? text_of(*scale, "scale") : "linear";
    if (name != "linear" && name != "log") fail(*scale, "scale", "expected \"linear\" or \"log\"");
    if (name == "log" && !(from > 0.0 && to > 0.0)) {
        fail(*scale, "scale", "a logarithmic range goes from and to positive numbers");
    }
    return name == "log";
}

/// The ends are met exactly.
std::vector<double> numbers_of_range(const Node& range) {
    const double from = number_of(range, "from"), to = number_of(range, "to");
    const double count = number_of(range, "count");
    if (count < 2 || count > kMostRuns || count != std::floor(count)) {
        fail(required(range, "count"), "count",
             fmt::format("expected a whole number from 2 to {}", kMostRuns));
    }
    const bool logarithmic = is_logarithmic(range, from, to);
    std::vector<double> numbers;
    for (int i = 0; i < static_cast<int>(count); ++i) {
        const double share = i / (count - 1);
        numbers.push_back(logarithmic ? from * std::pow(to / from, share)
                                      : from + (to - from) * share);
    }
    numbers.back() = to;
    return numbers;
}

/// Between whole ends, whole numbers where all of them are: for keys that take no others.
bool all_whole(const Node& range, std::vector<double>& numbers) {
    for (const char* end : {"from", "to"}) {
        if (!std::holds_alternative<std::int64_t>(required(range, end).value)) return false;
    }
    constexpr double kRounding = 1e-9;
    const auto is_whole = [](double x) {
        return std::abs(x - std::round(x)) <= kRounding * std::max(1.0, std::abs(x));
    };
    if (!std::ranges::all_of(numbers, is_whole)) return false;
    for (double& x : numbers) x = std::round(x);
    return true;
}

/// Those between the ends as a person would write them, so that results can be selected by them:
/// 1000, not 999.9999999999998, and nought where a range passes it.
void round_between(std::vector<double>& numbers) {
    constexpr double kNought = 1e-12;
    const double length = std::abs(numbers.back() - numbers.front());
    const bool passes_nought = numbers.front() * numbers.back() < 0.0;
    for (std::size_t i = 1; i + 1 < numbers.size(); ++i) {
        const std::string text = fmt::format("{:.12g}", numbers[i]);
        if (passes_nought && std::abs(numbers[i]) < kNought * length)
            numbers[i] = 0.0;
        else
            std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
    }
}

Axis read_range(const Node& table, const Node& range) {
    Axis axis{read_keys(table), {}};
    if (axis.keys.size() != 1 || !range.is_table()) {
        fail(range, "range",
             "expected { from = 1e3, to = 1e6, count = 4, scale = \"log\" } of one key");
    }
    check_members(range, {"from", "to", "count", "scale"});
    std::vector<double> numbers = numbers_of_range(range);
    const bool whole = all_whole(range, numbers);
    if (!whole) round_between(numbers);
    for (const double x : numbers) {
        const Value value = whole ? Value(static_cast<std::int64_t>(x)) : Value(x);
        axis.steps.push_back({{axis.keys.front(), value, range.mark}});
    }
    return axis;
}

std::string read_file(const Node& table, const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) {
        fail(table, "table", "'" + path.string() + "' cannot be read");
    }
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string::npos) return "";
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Axis read_table(const Node& table, const std::string& sweep_path) {
    for (const char* key : {"key", "keys"}) {
        if (const Node* node = table.find(key))
            fail(*node, key, "the head of the table names the keys");
    }
    const Node& node = *table.find("table");
    const auto path = std::filesystem::path(sweep_path).parent_path() / text_of(node, "table");
    const auto lines = parse_csv(read_file(node, path));
    if (lines.size() < 2)
        fail(node, "table", "expected a line of keys, and lines of values below it");
    Axis axis;
    for (const std::string& key : lines.front()) axis.keys.push_back(trimmed(key));
    for (std::size_t row = 1; row < lines.size(); ++row) {
        const std::string place = fmt::format("{}: row {}", path.string(), row);
        if (lines[row].size() != axis.keys.size()) {
            throw UserError(fmt::format("{}: {} values, and {} keys in the head", place,
                                        lines[row].size(), axis.keys.size()));
        }
        std::vector<Setting> step;
        for (std::size_t k = 0; k < axis.keys.size(); ++k) {
            const std::string origin = fmt::format("{}, {}", place, axis.keys[k]);
            const Node value = parse_toml_value(trimmed(lines[row][k]), origin);
            step.push_back({axis.keys[k], to_json(value), value.mark});
        }
        axis.steps.push_back(std::move(step));
    }
    return axis;
}

}  // namespace

Axis read_axis(const Node& table, const std::string& path) {
    check_members(table, {"key", "keys", "values", "range", "table"});
    const int forms = (table.find("values") != nullptr) + (table.find("range") != nullptr) +
                      (table.find("table") != nullptr);
    if (forms != 1) {
        throw UserError(table.mark.text() +
                        ": an [[axis]] needs exactly one of 'values', 'range' and 'table'");
    }
    if (const Node* values = table.find("values")) return read_values(table, *values);
    if (const Node* range = table.find("range")) return read_range(table, *range);
    return read_table(table, path);
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
    std::vector<std::vector<std::string>> lines;
    std::vector<std::string> line{""};
    bool quoted = false;
    const auto end_line = [&] {
        if (line.size() > 1 || !trimmed(line.front()).empty()) lines.push_back(line);
        line = {""};
    };
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // spreadsheets begin with it
    std::size_t i = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    for (; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
            line.back() += text[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (quoted)
            line.back() += c;
        else if (c == ',')
            line.emplace_back();
        else if (c == '\n')
            end_line();
        else if (c != '\r')
            line.back() += c;
    }
    end_line();
    return lines;
}

}  // namespace weft::batch
