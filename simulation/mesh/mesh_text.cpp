#include "simulation/mesh/mesh_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "runtime/error.h"
#include "simulation/mesh/parse_number.h"

namespace weft {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::string read_mesh_text(const std::string& path, const std::string& what) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw UserError(path + ": no such mesh file");
    if (std::filesystem::is_directory(status)) {
        throw UserError(path + ": is a folder, expected " + what);
    }
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file) throw UserError(path + ": cannot be read");
    std::string text(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)), '\0');
    file.seekg(0);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file) throw UserError(path + ": cannot be read");
    if (text.empty()) throw UserError(path + ": is empty, expected " + what);
    return text;
}

std::string quoted(std::string_view word) {
    std::string text;
    for (const char c : word.substr(0, 32)) text += c >= ' ' && c <= '~' ? c : '?';
    return fmt::format("'{}{}'", text, word.size() > 32 ? "..." : "");
}

std::string_view next_word(std::string_view& rest) {
    std::size_t begin = 0;
    while (begin < rest.size() && is_space(rest[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest.size() && !is_space(rest[end])) ++end;
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

void MeshWords::fail(const std::string& what) const {
    throw UserError(fmt::format("{}:{}: {}", path_, line_, what));
}

void MeshWords::skip_space() {
    while (!rest_.empty() && (is_space(rest_.front()) || rest_.front() == '\n')) {
        if (rest_.front() == '\n') ++line_;
        rest_.remove_prefix(1);
    }
}

bool MeshWords::at_end() {
    skip_space();
    return rest_.empty();
}

std::string_view MeshWords::rest_of_line() {
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(line.size());
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    return line;
}

std::string_view MeshWords::next_line() {
    const std::string_view line = rest_of_line();
    if (!rest_.empty()) {
        rest_.remove_prefix(1);
        ++line_;
    }
    return line;
}

std::string_view MeshWords::word(std::string_view expected) {
    skip_space();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    if (end == 0) fail(fmt::format("the file ends here, expected {}", expected));
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
}

std::int64_t MeshWords::integer(std::string_view expected) {
    const std::string_view text = word(expected);
    std::int64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error != std::errc{} || end != last) {
        fail(fmt::format("{}: expected {}, an integer", quoted(text), expected));
    }
    return value;
}

double MeshWords::number(std::string_view expected) {
    const std::string_view text = word(expected);
    const std::optional<double> value = parse_number(text);
    if (!value) fail(fmt::format("{}: expected {}, a number", quoted(text), expected));
    return *value;
}

std::size_t MeshWords::count(std::string_view expected, std::size_t bytes) {
    const std::int64_t value = integer(expected);
    if (value < 0) fail(fmt::format("{} = {}: must not be negative", expected, value));
    if (static_cast<std::uint64_t>(value) > rest_.size() / bytes + 1) {
        fail(fmt::format("{} = {}: the file is too short for so many", expected, value));
    }
    return static_cast<std::size_t>(value);
}

Vec3 MeshWords::position() {
    constexpr std::array<std::string_view, 3> kNames{"coordinate x", "coordinate y",
                                                     "coordinate z"};
    std::array<double, 3> x{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = number(kNames[axis]);
        if (std::abs(x[axis]) <= kMaxCoordinate) continue;
        fail(fmt::format("{} = {}: must be finite and within {} m", kNames[axis], x[axis],
                         kMaxCoordinate));
    }
    return {x[0], x[1], x[2]};
}

}  // namespace weft
