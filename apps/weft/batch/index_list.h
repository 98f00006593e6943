#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace weft::batch {

/// "7", "0-47", "3,9-11": numbers of runs, ascending, each once; "all" is what `all` holds. Throws
/// UserError where the text is no such list, or names a run that is not below `count`.
std::vector<std::size_t> parse_indices(const std::string& text, std::size_t count,
                                       const std::vector<std::size_t>& all);

/// Ascending numbers as job arrays take them: "1,3-7".
std::string to_ranges(const std::vector<std::size_t>& indices);
/// The same as a list of Python's: "[1, *range(3, 8)]".
std::string to_python(const std::vector<std::size_t>& indices);

}  // namespace weft::batch
