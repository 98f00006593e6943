#pragma once

#include <optional>
#include <string_view>

namespace weft {

/// The whole word as a number, correctly rounded and whatever the locale; "nan" and "inf" are
/// numbers here. What is too large becomes infinite, what is too small 0. Nothing otherwise.
std::optional<double> parse_number(std::string_view word);

/// The same, by the C library: for standard libraries that lack std::from_chars for double, as
/// libc++ did before version 20.
std::optional<double> parse_number_by_strtod(std::string_view word);

}  // namespace weft
