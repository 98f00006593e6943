#include "apps/weft/batch/index_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <set>
#include <utility>

#include "runtime/error.h"

namespace weft::batch {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw UserError(fmt::format(
        "--index {}: {}; expected numbers of runs, as in 7, 0-47, 3,9-11 or all", text, why));
}

std::size_t parse_number(std::string_view digits, const std::string& text, std::size_t count) {
    std::size_t number = 0;
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, number);
    if (error == std::errc::invalid_argument || stop != end) {
        refuse(text, fmt::format("'{}' is no number", digits));
    }
    if (error != std::errc{} || number >= count) {
        refuse(text, fmt::format("there is no run {}; the last one is {}", digits, count - 1));
    }
    return number;
}

/// First and last of the numbers that follow each other.
std::vector<std::pair<std::size_t, std::size_t>> stretches(
    const std::vector<std::size_t>& indices) {
    std::vector<std::pair<std::size_t, std::size_t>> list;
    for (const std::size_t index : indices) {
        if (list.empty() || list.back().second + 1 != index) list.emplace_back(index, index);
        list.back().second = index;
    }
    return list;
}

}  // namespace

std::vector<std::size_t> parse_indices(const std::string& text, std::size_t count,
                                       const std::vector<std::size_t>& all) {
    if (count == 0) refuse(text, "the sweep has no runs");
    if (text == "all") return all;
    std::set<std::size_t> indices;
    std::string_view rest = text;
    while (true) {
        const std::string_view part = rest.substr(0, rest.find(','));
        const std::size_t dash = part.find('-');
        const std::size_t first = parse_number(part.substr(0, dash), text, count);
        const std::size_t last =
            dash == part.npos ? first : parse_number(part.substr(dash + 1), text, count);
        if (last < first) refuse(text, fmt::format("'{}' runs backwards", part));
        for (std::size_t i = first; i <= last; ++i) indices.insert(i);
        if (part.size() == rest.size()) return {indices.begin(), indices.end()};
        rest.remove_prefix(part.size() + 1);
    }
}

std::string to_ranges(const std::vector<std::size_t>& indices) {
    std::vector<std::string> parts;
    for (const auto& [first, last] : stretches(indices)) {
        parts.push_back(first == last ? fmt::format("{}", first)
                                      : fmt::format("{}-{}", first, last));
    }
    return fmt::format("{}", fmt::join(parts, ","));
}

std::string to_python(const std::vector<std::size_t>& indices) {
    std::vector<std::string> parts;
    for (const auto& [first, last] : stretches(indices)) {
        parts.push_back(first == last ? fmt::format("{}", first)
                                      : fmt::format("*range({}, {})", first, last + 1));
    }
    return fmt::format("[{}]", fmt::join(parts, ", "));
}

}  // namespace weft::batch
