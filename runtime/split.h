#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// The texts between the marks: one more than there are marks, so some may be empty.
std::vector<std::string> split(std::string_view text, char mark);

}  // namespace weft
