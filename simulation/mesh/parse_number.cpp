#include "simulation/mesh/parse_number.h"

#include <charconv>
#include <limits>
#include <version>

#if !defined(__cpp_lib_to_chars)
#include <locale>
#include <sstream>
#include <string>
#endif

namespace weft {
#if defined(__cpp_lib_to_chars)

std::optional<double> parse_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error == std::errc::invalid_argument) return {};
    if (error == std::errc{}) return value;
    const bool is_small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return is_small ? 0.0 : std::numeric_limits<double>::infinity();
}

#else  // libc++ has had std::from_chars for double only since version 20

std::optional<double> parse_number(std::string_view word) {
    for (const char* odd : {"nan", "-nan", "inf", "-inf", "NaN", "Inf", "-Inf"}) {
        if (word == odd) return std::numeric_limits<double>::quiet_NaN();
    }
    std::istringstream stream{std::string(word)};
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> value;
    if (word.empty() || stream.bad() || stream.peek() != std::istringstream::traits_type::eof())
        return {};
    return value;  // out of range: the stream has set the largest double, or 0
}

#endif
}  // namespace weft
