#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

/// What the values of options must be; CLI11 puts the option's name before their messages.
namespace weft {

/// Accepts one of `choices`; otherwise suggests the nearest.
CLI::Validator one_of(std::vector<std::string> choices);

/// Accepts a finite number above 0, or of 0 and more.
CLI::Validator above_zero();
CLI::Validator zero_or_more();

/// Accepts a whole number that an int can hold; with `least`, that or more.
CLI::Validator whole_number(std::optional<int> least = std::nullopt);

/// Accepts what can be a file's or folder's name; not the option behind an empty one.
CLI::Validator path_name();

}  // namespace weft
