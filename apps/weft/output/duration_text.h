#pragma once

#include <string>

namespace weft {

/// "4.2 s", "1 min 05 s", "2 h 10 min"
std::string duration_text(double seconds);

}  // namespace weft
