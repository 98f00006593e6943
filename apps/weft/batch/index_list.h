#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace weft::batch {

/// "7", "0-47", "3,9-11", "all": numbers of runs, ascending, each once. Throws UserError where the
/// text is no such list, or names a run that is not below `count`.
std::vector<std::size_t> parse_indices(const std::string& text, std::size_t count);

/// Ascending numbers as job arrays take them: "1,3-7".
std::string to_ranges(const std::vector<std::size_t>& indices);

}  // namespace weft::batch
