#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace weft {

/// The message and the near miss for a command line that CLI11 refused; one line.
std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace weft
