#pragma once

#include <string>

#include "apps/weft/batch/sweep.h"

namespace weft::batch {

/// One [[axis]]: `key` or `keys` with `values`, `range` or `table`. A table is a CSV file, relative
/// to the sweep file at `path`, whose head names the keys. Throws UserError.
Axis read_axis(const Node& table, const std::string& path);

/// The cells of a CSV text, line by line; quoted ones may hold commas, quotes (doubled) and line
/// breaks. Empty lines are left out.
std::vector<std::vector<std::string>> parse_csv(const std::string& text);

}  // namespace weft::batch
