#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft {

/// How much work goes into making output small.
enum class Compression { kNone, kFast, kSmall };

std::string_view name_of(Compression compression);
std::vector<std::string> compression_names();
/// `name` is one of them.
Compression compression_named(std::string_view name);

}  // namespace weft
