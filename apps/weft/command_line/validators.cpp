#include "apps/weft/command_line/validators.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/near_miss.h"

namespace weft {
namespace {

CLI::Validator number_where(bool (*holds)(double), const std::string& expected) {
    const auto check = [=](const std::string& text) -> std::string {
        double value = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
        if (is_number && holds(value)) return "";
        return fmt::format("'{}': expected {}", text, expected);
    };
    return CLI::Validator(check, "");
}

}  // namespace

CLI::Validator one_of(std::vector<std::string> choices) {
    const auto check = [choices = std::move(choices)](const std::string& value) -> std::string {
        if (std::find(choices.begin(), choices.end(), value) != choices.end()) return "";
        return fmt::format("'{}' is unknown; {}", value, near_miss_or_list(value, choices));
    };
    return CLI::Validator(check, "");
}

CLI::Validator above_zero() {
    return number_where([](double value) { return value > 0.0; }, "a number above 0");
}

CLI::Validator zero_or_more() {
    return number_where([](double value) { return value >= 0.0; }, "a number, 0 or more");
}

CLI::Validator whole_number(std::optional<int> least) {
    const auto check = [least](const std::string& text) -> std::string {
        int value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= least.value_or(value)) return "";
        const bool is_large = text.size() > 9 && text.find_first_not_of("0123456789") == text.npos;
        return fmt::format(
            "'{}': expected a whole number{}{}", text,
            least ? fmt::format(", {} or more", *least) : "",
            is_large ? fmt::format(", at most {}", std::numeric_limits<int>::max()) : "");
    };
    return CLI::Validator(check, "");
}

CLI::Validator path_name() {
    const auto check = [](const std::string& value) -> std::string {
        if (!value.empty() && !value.starts_with("--")) return "";
        return fmt::format("'{}': expected the name of a file or folder", value);
    };
    return CLI::Validator(check, "");
}

}  // namespace weft
