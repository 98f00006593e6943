#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// "did you mean 'frames'?" for "framez", or "" where no candidate is near enough.
std::string near_miss(std::string_view word, const std::vector<std::string>& candidates);

/// The near miss if there is one, otherwise "known: a, b, c". Ready to follow "; ".
std::string near_miss_or_list(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace weft
